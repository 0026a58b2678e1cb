"""SciPy: solve_ivp with DOP853, impacts as terminal events, a restart after each."""

import math

from scipy.integrate import solve_ivp

ATOL = 1e-3


def pulse(tolerance, numbers):
    p2, alpha, ratio, amplitude, omega, start, end, t_end = numbers
    sin, cos = math.sin, math.cos

    def forced(t, w, side):
        return w[1], p2 * (sin(w[0]) + side * amplitude * sin(omega * t) * cos(w[0]))

    def free(_, w, side):
        return w[1], p2 * sin(w[0])

    def impact(_, w, side):
        return w[0] - alpha

    impact.terminal = True
    impact.direction = 1.0

    def run():
        side, state, times = -1.0, [alpha, 0.0], []
        for slope, t, stop in [(forced, start, end), (free, end, t_end)]:
            while t < stop:
                solution = solve_ivp(
                    slope, (t, stop), state, "DOP853", events=impact, rtol=tolerance, atol=ATOL * tolerance, args=(side,)
                )
                t, state = solution.t[-1], solution.y[:, -1]
                if solution.status == 1:
                    times.append(t)
                    side, state = -side, [alpha, -ratio * state[1]]
        return times + [side * (alpha - state[0])]

    return run


def hinges(tolerance, numbers):
    m00, m11, m22, a01, b01, a02, b02, a12, b12, u0, v0, u1, v1, u2, v2, gravity, amplitude, omega = numbers[:18]
    start, t_end = numbers[18:24], numbers[24]
    sin, cos = math.sin, math.cos

    def slope(t, x):
        t0, t1, t2, w0, w1, w2 = x.tolist()
        ground = amplitude * sin(omega * t)
        s, c = sin(t1 - t0), cos(t1 - t0)
        m01, n01 = a01 * c + b01 * s, b01 * c - a01 * s
        s, c = sin(t2 - t0), cos(t2 - t0)
        m02, n02 = a02 * c + b02 * s, b02 * c - a02 * s
        s, c = sin(t2 - t1), cos(t2 - t1)
        m12, n12 = a12 * c + b12 * s, b12 * c - a12 * s

        def load(u, v, angle):
            return gravity * (u * cos(angle) + v * sin(angle)) - ground * (v * cos(angle) - u * sin(angle))

        r0 = load(u0, v0, t0) - n01 * w1 * w1 - n02 * w2 * w2
        r1 = load(u1, v1, t1) + n01 * w0 * w0 - n12 * w2 * w2
        r2 = load(u2, v2, t2) + n02 * w0 * w0 + n12 * w1 * w1
        f0, f1 = m02 / m22, m12 / m22
        p00, p01, p11 = m00 - f0 * m02, m01 - f0 * m12, m11 - f1 * m12
        q0, q1 = r0 - f0 * r2, r1 - f1 * r2
        determinant = p00 * p11 - p01 * p01
        e0, e1 = (q0 * p11 - q1 * p01) / determinant, (q1 * p00 - q0 * p01) / determinant
        return w0, w1, w2, e0, e1, (r2 - m02 * e0 - m12 * e1) / m22

    def run():
        solution = solve_ivp(slope, (0.0, t_end), start, "DOP853", rtol=tolerance, atol=ATOL * tolerance)
        return solution.y[:3, -1].tolist()

    return run
