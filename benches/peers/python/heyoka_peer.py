"""heyoka: Taylor series compiled for the equations; impacts are terminal events.

The block is that of src/peers/block.rs: w'' = p2 (sin w + drive cos w), an impact where w rises to alpha. Python is called back
at each impact and drives each stretch of ground motion; a record is 3000 stretches.
"""

import heyoka as hy


def rocking(tolerance, alpha, ratio, acceleration, w, v, times, pars):
    """An integrator whose impacts reverse the rate, change the sign of the first parameter, and go to `times`."""

    def impact(ta, _):
        state = ta.state
        state[0] = alpha
        state[1] *= -ratio
        if pars:
            parameters = ta.pars
            parameters *= -1.0
        times.append(ta.time)
        return True

    event = hy.t_event(w - alpha, callback=impact, direction=hy.event_direction.positive)
    return hy.taylor_adaptive(
        [(w, v), (v, acceleration)], [alpha, 0.0], t_events=[event], pars=[0.0] * pars, tol=tolerance, fast_math=True
    )


def pulse(tolerance, numbers):
    p2, alpha, ratio, amplitude, omega, start, end, t_end = numbers
    w, v = hy.make_vars("w", "v")
    times = []
    drive = hy.par[0] * hy.sin(omega * hy.time)
    forced = rocking(tolerance, alpha, ratio, p2 * (hy.sin(w) + drive * hy.cos(w)), w, v, times, 1)
    free = rocking(tolerance, alpha, ratio, p2 * hy.sin(w), w, v, times, 0)
    state, parameters, after = forced.state, forced.pars, free.state

    def run():
        times.clear()
        forced.time = start
        state[0], state[1] = alpha, 0.0
        parameters[0] = -amplitude
        forced.propagate_until(end)
        free.time = end
        after[:] = state
        free.propagate_until(t_end)
        # It opens to the left and changes sides with each impact.
        side = -1.0 if len(times) % 2 == 0 else 1.0
        return times + [side * (alpha - after[0])]

    return run


def record(tolerance, numbers):
    p2, alpha, ratio, dt, side, first, start, *accel = numbers
    w, v, u = hy.make_vars("w", "v", "u")
    times = []
    # Both parameters change their sign with the side. The integrator's time is that since the sample.
    drive = hy.par[0] + hy.par[1] * hy.time
    ta = rocking(tolerance, alpha, ratio, p2 * (hy.sin(w) + drive * hy.cos(w)), w, v, times, 2)
    state, parameters = ta.state, ta.pars
    first = int(first)
    slopes = [(after - before) / dt for before, after in zip(accel, accel[1:])]
    stretches = list(zip(accel, slopes))[first:]

    def run():
        impacts, sign, at = [], side, start
        state[0], state[1] = alpha, 0.0
        for place, (value, slope) in enumerate(stretches, first):
            parameters[0], parameters[1] = sign * value, sign * slope
            ta.time = at
            at = 0.0
            ta.propagate_until(dt)
            if times:
                impacts.extend(place * dt + own for own in times)
                if len(times) % 2:
                    sign = -sign
                times.clear()
        return impacts + [sign * (alpha - state[0])]

    return run


def accelerations(diagonal, coupling, weight, gravity, ground, theta, rate):
    """Of three hinges: the equations of src/peers/hinges.rs as expressions."""
    sin, cos = [hy.sin(angle) for angle in theta], [hy.cos(angle) for angle in theta]
    mass = [[None] * 3 for _ in range(3)]
    slope = [[None] * 3 for _ in range(3)]
    for (k, l), (a, b) in zip([(0, 1), (0, 2), (1, 2)], coupling):
        s, c = sin[l] * cos[k] - cos[l] * sin[k], cos[l] * cos[k] + sin[l] * sin[k]
        mass[k][l] = a * c + b * s
        slope[k][l] = b * c - a * s
    load = []
    for k, (u, v) in enumerate(weight):
        terms = [gravity * (u * cos[k] + v * sin[k]), -ground * (v * cos[k] - u * sin[k])]
        terms += [-slope[k][l] * rate[l] ** 2.0 for l in range(k + 1, 3)]
        terms += [slope[l][k] * rate[l] ** 2.0 for l in range(k)]
        load.append(hy.sum(terms))
    f0, f1 = mass[0][2] / diagonal[2], mass[1][2] / diagonal[2]
    m00, m01, m11 = diagonal[0] - f0 * mass[0][2], mass[0][1] - f0 * mass[1][2], diagonal[1] - f1 * mass[1][2]
    r0, r1 = load[0] - f0 * load[2], load[1] - f1 * load[2]
    determinant = m00 * m11 - m01 * m01
    a0, a1 = (r0 * m11 - r1 * m01) / determinant, (r1 * m00 - r0 * m01) / determinant
    return [a0, a1, (load[2] - mass[0][2] * a0 - mass[1][2] * a1) / diagonal[2]]


def hinged(numbers):
    """Variables and accelerations from the scene's constants."""
    pairs = list(zip(numbers[3:15:2], numbers[4:15:2]))
    diagonal, coupling, weight = numbers[:3], pairs[:3], pairs[3:]
    gravity, amplitude, omega = numbers[15:18]
    variables = hy.make_vars("a", "b", "c", "p", "q", "r")
    ground = amplitude * hy.sin(omega * hy.time)
    return variables, accelerations(diagonal, coupling, weight, gravity, ground, variables[:3], variables[3:])


def hinges(tolerance, numbers):
    variables, alpha = hinged(numbers)
    start, t_end = numbers[18:24], numbers[24]
    system = list(zip(variables, variables[3:] + alpha))
    ta = hy.taylor_adaptive(system, start, tol=tolerance, fast_math=True)
    state = ta.state

    def run():
        ta.time = 0.0
        state[:] = start
        ta.propagate_until(t_end)
        return state[:3].tolist()

    return run


def slope(numbers):
    """Accelerations at the start, at the time that stands for the end."""
    variables, alpha = hinged(numbers)
    function = hy.cfunc(alpha, variables)
    return function(numbers[18:24], time=numbers[24])
