"""Peers in Python: answers lines on standard input, a line each.

    programs                                   names of those that are installed
    answer PROGRAM TOLERANCE SCENE NUMBERS     what the run finds: times of impacts, angles at the end
    time RUNS PROGRAM TOLERANCE SCENE NUMBERS  seconds for so many runs
    slope PROGRAM NUMBERS                      accelerations of the three hinges at a state

A program is a module of this folder with functions named like the scenes: each takes the tolerance and the scene's numbers and
returns a function that runs it. What is compiled is kept.
"""

import importlib
import sys
import time

PROGRAMS = {}
for name in ("heyoka", "scipy", "mujoco"):
    try:
        PROGRAMS[name] = importlib.import_module(name + "_peer")
    except ImportError:
        pass

kept = {}


def runner(words):
    key = tuple(words)
    if key not in kept:
        program, tolerance, scene, *numbers = words
        kept[key] = getattr(PROGRAMS[program], scene)(float(tolerance), [float(number) for number in numbers])
    return kept[key]


def answer(words):
    return " ".join(repr(float(number)) for number in runner(words)())


def timed(runs, words):
    run = runner(words)
    start = time.perf_counter()
    for _ in range(runs):
        run()
    return repr(time.perf_counter() - start)


for line in sys.stdin:
    what, *words = line.split()
    if what == "programs":
        print(" ".join(PROGRAMS))
    elif what == "answer":
        print(answer(words))
    elif what == "time":
        print(timed(int(words[0]), words[1:]))
    elif what == "slope":
        numbers = [float(number) for number in words[1:]]
        print(" ".join(repr(float(number)) for number in PROGRAMS[words[0]].slope(numbers)))
