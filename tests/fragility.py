"""Probit regressions by statsmodels of the data that tests/fragility.rs has; a line per fit: median, dispersion, log-likelihood.

Input: lines `level runs reached`, fits separated by an empty line.
"""
import sys

import numpy as np
import statsmodels.api as sm

for block in sys.stdin.read().strip().split("\n\n"):
    level, runs, reached = np.array([line.split() for line in block.split("\n")], dtype=float).T
    keep = runs > 0
    counts = np.column_stack([reached, runs - reached])[keep]
    family = sm.families.Binomial(link=sm.families.links.Probit())
    model = sm.GLM(counts, sm.add_constant(np.log(level[keep])), family=family)
    a, b = model.fit(tol=1e-14, maxiter=200).params
    # One by one, without binomial coefficients.
    y = np.concatenate([np.r_[np.ones(int(k)), np.zeros(int(n - k))] for n, k in zip(runs, reached)])
    x = np.repeat(np.log(level), runs.astype(int))
    likelihood = sm.Probit(y, sm.add_constant(x)).loglike([a, b])
    print(repr(float(np.exp(-a / b))), repr(float(1 / b)), repr(float(likelihood)))
