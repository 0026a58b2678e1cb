"""Fractiles and lognormal fragility of a table of `rocking ida`, by hand with NumPy: ida.py TABLE MEASURE.

Prints a line per level (level, 16, 50 and 84 % fractile of the largest |theta|/alpha) and then median and dispersion of overturning.
"""
import csv
import math
import sys

import numpy as np

rows = list(csv.DictReader(open(sys.argv[1])))
level = np.array([float(row[sys.argv[2]]) for row in rows])
lost = np.array([row["outcome"] in ("overturns", "collapses") for row in rows])
peak = np.array([max(float(row[name]) for name in row if name.startswith("peak_")) for row in rows])
peak[lost] = np.inf
for x in np.unique(level):
    values = np.sort(peak[level == x])
    ranks = [math.ceil(share * len(values) - 1e-9) for share in (0.16, 0.5, 0.84)]
    print(repr(float(x)), *(repr(float(values[rank - 1])) for rank in ranks))
# The likelihood on finer and finer grids.
phi = np.vectorize(lambda z: 0.5 * math.erfc(-z / math.sqrt(2)))
x = np.log(level)
centre, reach = np.array([np.log(np.median(level)), np.log(0.3)]), 2.0
for _ in range(40):
    grid = np.linspace(-reach, reach, 9)
    best = max(
        (
            float(np.sum(np.log(np.clip(np.where(lost, p, 1 - p), 1e-300, 1)))),
            centre[0] + a,
            centre[1] + b,
        )
        for a in grid
        for b in grid
        for p in [phi((x - centre[0] - a) / math.exp(centre[1] + b))]
    )
    centre, reach = np.array(best[1:]), 0.6 * reach
print(repr(float(np.exp(centre[0]))), repr(float(np.exp(centre[1]))))
