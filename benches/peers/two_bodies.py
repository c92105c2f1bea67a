"""The two-body rocking wall of docs/model.md once more, with scipy's solve_ivp and its events.

Written for comparison: the motion as plain numbers, impacts as projections with numpy matrices, every change of the
contact state an event of solve_ivp. It shares no code with mrbd.
"""

import math
from bisect import bisect_right

import numpy as np
from scipy.integrate import solve_ivp

GRAVITY = 9.81
JUST_AFTER_S = 1e-8
# Changes of pattern that Table 2 names, for the positive side; mirrored ones share the coefficient.
TABLE_2 = {("1a", "2a"): 0, ("2a", "1a"): 1, ("1a", "2b"): 2, ("2a", "1b"): 3,
           ("3a", "1b"): 4, ("3a", "3b"): 5, ("1a", "3a"): 6, ("2a", "3a"): 7}
# All contact states (ground, crack), those with fewest open joints first.
STATES = sorted(((g, c) for g in (0, 1, -1) for c in (0, 1, -1)), key=lambda s: abs(s[0]) + abs(s[1]))


def pattern(state):
    """The paper's name of a contact state."""
    ground, crack = state
    if state == (0, 0):
        return "rest"
    side = ground or crack
    number = {(1, 1): 1, (1, -1): 2, (1, 0): 3, (0, 1): 4}[(ground * side, crack * side)]
    return f"{number}{'a' if side > 0 else 'b'}"


def mirrored(name):
    return name.replace("a", "#").replace("b", "a").replace("#", "b")


def free_ways(state):
    """Columns: how the two rotations may change in a contact state."""
    ground, crack = state
    ways = {(0, 0): np.zeros((2, 0)), (1, 0): np.array([[1.0], [1.0]]), (0, 1): np.array([[0.0], [1.0]]),
            (1, 1): np.eye(2)}
    return ways[(abs(ground), abs(crack))]


class TwoBodies:
    """A wall from the tables of its TOML file, without effects."""

    def __init__(self, wall, corners, diaphragm, restitution):
        self.b = wall["thickness_m"]
        self.h1, h = wall["crack_height_m"], wall["height_m"]
        self.h2 = h - self.h1
        self.m1, self.m2 = (wall["mass_kg"] * part / h for part in (self.h1, self.h2))
        self.i1, self.i2 = (m * (self.b**2 + part**2) / 12 for m, part in ((self.m1, self.h1), (self.m2, self.h2)))
        self.b1, self.b2 = corners["lower_width_m"], corners["upper_width_m"]
        self.md, self.mdp = diaphragm["mass_kg"], diaphragm["carriage_mass_kg"]
        self.k = diaphragm["stiffness_n_per_m"]
        self.c = restitution["coefficients"]
        self.whole = restitution["law"] == "whole"
        self.capture = restitution["capture_velocity_rad_s"]

    def arms(self, state, t1, t2):
        """Turned arms: ground corner to G1, to the crack corner Q; Q to G2, to C."""
        o, q = state[0] * self.b1 / 2, state[1] * self.b2 / 2
        s1, c1, s2, c2 = math.sin(t1), math.cos(t1), math.sin(t2), math.cos(t2)

        def turned(x, y, s, c):
            return x * c + y * s, -x * s + y * c

        return (turned(-o, self.h1 / 2, s1, c1), turned(q - o, self.h1, s1, c1),
                turned(-q, self.h2 / 2, s2, c2), turned(-q, self.h2, s2, c2))

    def equations(self, state, t1, t2, w1, w2, ground):
        """Mass matrix and right-hand side of the rotations' accelerations, both joints free."""
        (x1, y1), (xq, yq), (x2, y2), (xc, yc) = self.arms(state, t1, t2)
        mx, my = self.md + self.mdp, self.md
        m11 = self.i1 + self.m1 * (x1 * x1 + y1 * y1) + self.m2 * (xq * xq + yq * yq) + mx * yq * yq + my * xq * xq
        m22 = self.i2 + self.m2 * (x2 * x2 + y2 * y2) + mx * yc * yc + my * xc * xc
        m12 = self.m2 * (xq * x2 + yq * y2) + mx * yq * yc + my * xq * xc
        # What every mass feels besides the rotations' accelerations: turning, ground, gravity.
        e, f = w1 * w1, w2 * w2
        a1x, a1y = ground - x1 * e, GRAVITY - y1 * e
        a2x, a2y = ground - xq * e - x2 * f, GRAVITY - yq * e - y2 * f
        acx, acy = ground - xq * e - xc * f, GRAVITY - yq * e - yc * f
        # The spring pulls C back by its displacement, from the corner at the ground on.
        spring = -self.k * (state[0] * self.b1 / 2 + xq + xc)
        top_x, top_y = spring - mx * acx, -my * acy
        r1 = (-self.m1 * (y1 * a1x - x1 * a1y) - self.m2 * (yq * a2x - xq * a2y) + yq * top_x - xq * top_y)
        r2 = -self.m2 * (y2 * a2x - x2 * a2y) + yc * top_x - xc * top_y
        return m11, m12, m22, r1, r2

    def accelerations(self, state, t1, t2, w1, w2, ground):
        m11, m12, m22, r1, r2 = self.equations(state, t1, t2, w1, w2, ground)
        if state[0] and state[1]:
            d = m11 * m22 - m12 * m12
            return (m22 * r1 - m12 * r2) / d, (m11 * r2 - m12 * r1) / d
        if state[0]:
            a = (r1 + r2) / (m11 + 2 * m12 + m22)
            return a, a
        return (0.0, r2 / m22) if state[1] else (0.0, 0.0)

    def corner_forces(self, joint, state, t1, t2, w1, w2, ground):
        """Normal forces at the left and the right corner of a closed joint: d'Alembert's balance of what is above."""
        p1, p2 = self.accelerations(state, t1, t2, w1, w2, ground)
        (x1, y1), (xq, yq), (x2, y2), (xc, yc) = self.arms(state, t1, t2)

        def motion(parts):
            ax = ground + sum(y * p - x * w * w for x, y, p, w in parts)
            ay = GRAVITY + sum(-x * p - y * w * w for x, y, p, w in parts)
            return ax, ay

        lower, to_q = (x1, y1, p1, w1), (xq, yq, p1, w1)
        a1, a2 = motion([lower]), motion([to_q, (x2, y2, p2, w2)])
        ac = motion([to_q, (xc, yc, p2, w2)])
        spring = -self.k * (state[0] * self.b1 / 2 + xq + xc)
        # Places about the joint's middle; the corners of a closed crack lie in the lower body's frame.
        if joint == 1:
            middle, width = (0.0, 0.0), self.b2
            qx, qy = state[1] * self.b2 / 2 * math.cos(t1), -state[1] * self.b2 / 2 * math.sin(t1)
            bodies = [(self.m2, self.i2 * p2, (qx + x2, qy + y2), a2)]
            c = (qx + xc, qy + yc)
        else:
            width = self.b1
            o = state[0] * self.b1 / 2
            bodies = [(self.m1, self.i1 * p1, (o + x1, y1), a1), (self.m2, self.i2 * p2, (o + xq + x2, yq + y2), a2)]
            c = (o + xq + xc, yq + yc)
        n = self.md * ac[1] + sum(m * a[1] for m, _, _, a in bodies)
        top_x = (self.md + self.mdp) * ac[0] - spring
        moment = c[1] * top_x - c[0] * self.md * ac[1]
        moment += sum(turn + m * (r[1] * a[0] - r[0] * a[1]) for m, turn, r, a in bodies)
        return n / 2 + moment / width, n / 2 - moment / width

    # Contact states

    def settled(self, state, y, ground):
        """The state in which fewest joints open: closed ones compressed, opened ones parting."""
        for candidate in STATES:
            if any(old and new != old for old, new in zip(state, candidate)):
                continue
            if self.holds(state, candidate, y, ground):
                return candidate
        raise RuntimeError(f"no contact state holds at {y}")

    def holds(self, old, state, y, ground):
        t1, t2, w1, w2 = y
        p1, p2 = self.accelerations(state, t1, t2, w1, w2, ground)
        apart = (p1 * state[0], (p2 - p1) * state[1])
        for joint in (0, 1):
            if not old[joint] and state[joint] and apart[joint] <= 0:
                return False
            if not state[joint] and min(self.corner_forces(joint, state, t1, t2, w1, w2, ground)) < 0:
                return False
        return True

    # Impacts

    def jacobian(self, state, t1, t2):
        """Velocities x, y, turn of both bodies, x and y of C, by both rotations' velocities."""
        (x1, y1), (xq, yq), (x2, y2), (xc, yc) = self.arms(state, t1, t2)
        return np.array([[y1, 0], [-x1, 0], [1, 0], [yq, y2], [-xq, -x2], [0, 1], [yq, yc], [-xq, -xc]])

    def impact(self, joint, state, y):
        """State and velocities after a joint, or both of a monolithic wall, came down on its other corner."""
        t1, t2, w1, w2 = y
        weights = np.array([self.m1, self.m1, self.i1, self.m2, self.m2, self.i2, self.md + self.mdp, self.md])
        before = self.jacobian(state, t1, t2) @ np.array([w1, w2])

        def projected(new):
            j = self.jacobian(new, t1, t2) @ free_ways(new)
            if not j.shape[1]:
                return np.zeros(2)
            left = j.T * weights
            return free_ways(new) @ np.linalg.solve(left @ j, left @ before)

        # A closed joint is at the impact too: it may open; an open joint that takes no part keeps its corner.
        meets = [k == joint or not state[k] for k in (0, 1)]
        best = None
        for new in STATES:
            if any(not meets[k] and new[k] != state[k] for k in (0, 1)):
                continue
            omega = projected(new)
            worst = self.admissible(meets, new, omega, before, weights, t1, t2)
            if best is None or worst > best[0] + 1e-12:
                best = worst, new, omega
        _, new, omega = best
        # What opens slower than the capture velocity closes.
        kept = list(new)
        for k, opening in enumerate((omega[0], omega[1] - omega[0])):
            if meets[k] and new[k] and abs(opening) < self.capture:
                kept[k] = 0
        if tuple(kept) != new:
            new = tuple(kept)
            omega = projected(new)
        return new, self.scaled(joint, state, new, omega, projected)

    def admissible(self, meets, new, omega, before, weights, t1, t2):
        """The least of what must not be negative: impulses at both corners of closed joints, velocities apart."""
        impulse = weights * (self.jacobian(new, t1, t2) @ omega - before)
        (x1, y1), (xq, yq), (x2, y2), (xc, yc) = self.arms(new, t1, t2)
        o, q = new[0] * self.b1 / 2, new[1] * self.b2 / 2
        qx, qy = q * math.cos(t1), -q * math.sin(t1)
        least = math.inf
        for k, opening in enumerate((omega[0], omega[1] - omega[0])):
            if not meets[k]:
                continue
            if new[k]:
                least = min(least, opening * new[k])
                continue
            # Impulses of everything above, about the joint's middle.
            g2, c = ((qx + x2, qy + y2), (qx + xc, qy + yc)) if k else ((o + xq + x2, yq + y2), (o + xq + xc, yq + yc))
            n = impulse[4] + impulse[7] + (0 if k else impulse[1])
            moment = impulse[5] + g2[1] * impulse[3] - g2[0] * impulse[4] + c[1] * impulse[6] - c[0] * impulse[7]
            if not k:
                moment += impulse[2] + y1 * impulse[0] - (o + x1) * impulse[1]
            width = self.b2 if k else self.b1
            # Comparable with velocities: over the mass of the wall.
            least = min(least, (n / 2 + moment / width) / self.m1, (n / 2 - moment / width) / self.m1)
        return min(least, 0.0) if least > -1e-12 else least

    def scaled(self, joint, state, new, omega, projected):
        old_name, new_name = pattern(state), pattern(new)
        c = TABLE_2.get((old_name, new_name), TABLE_2.get((mirrored(old_name), mirrored(new_name))))
        if c is None:
            return omega
        if self.whole:
            return self.c[c] * omega
        stuck = list(state)
        stuck[joint] = 0
        u = projected(tuple(stuck))
        return u + self.c[c] * (omega - u)


def simulate(wall, times, accelerations, end_s, tolerance=1e-6):
    """Largest rotations, numbers of impacts and evaluations of a run from rest."""
    slope = [(b - a) / (t - s) for a, b, s, t in zip(accelerations, accelerations[1:], times, times[1:])]
    last, first_slope = times[-1], len(slope) - 1

    def ground(t):
        if t >= last:
            return 0.0
        k = min(bisect_right(times, t) - 1, first_slope)
        return accelerations[k] + slope[k] * (t - times[k])

    run = {"largest": [0.0, 0.0], "impacts": 0, "evaluations": 0}
    t, y, state = 0.0, np.zeros(4), (0, 0)
    while t < end_s - 1e-12:
        if state == (0, 0):
            t, state = next_opening(wall, times, ground, t, end_s)
            continue
        t, y, state = until_event(wall, ground, t, y, state, end_s, tolerance, run, times[1] - times[0])
    return run


def next_opening(wall, times, ground, t, end_s):
    """At rest forces go with the ground's acceleration, linear between samples: the first sample interval they change sign in."""
    def least(s):
        return min(min(wall.corner_forces(k, (0, 0), 0.0, 0.0, 0.0, 0.0, ground(s))) for k in (0, 1))

    while t < end_s:
        k = bisect_right(times, t)
        end = times[k] if k < len(times) else end_s
        end = min(end, end_s)
        if least(end - 1e-12) < 0:
            a, b = t, end - 1e-12
            for _ in range(60):
                middle = 0.5 * (a + b)
                a, b = (a, middle) if least(middle) < 0 else (middle, b)
            state = wall.settled((0, 0), (0.0, 0.0, 0.0, 0.0), ground(b))
            if state != (0, 0):
                return b, state
        t = end
    return t, (0, 0)


def until_event(wall, ground, t, y, state, end_s, tolerance, run, step_s):
    """One stretch of solve_ivp between two changes of the contact state."""
    def motion(s, y):
        p1, p2 = wall.accelerations(state, y[0], y[1], y[2], y[3], ground(s))
        return (y[2], y[3], p1, p2)

    def event(function):
        function.terminal, function.direction = True, -1
        return function

    began = t

    def opening(k, s, y):
        # A joint opened just now stands at zero, which is no closing: solve_ivp would find its root there.
        return state[k] * (y[0] if k == 0 else y[1] - y[0]) if s > began else math.ulp(0.0)

    events, closing = [], []
    for k in (0, 1):
        if state[k]:
            events.append(event(lambda s, y, k=k: opening(k, s, y)))
            closing.append(k)
        else:
            events.append(event(lambda s, y, k=k: min(wall.corner_forces(k, state, *y, ground(s)))))
            closing.append(None)
    # Where a rotation turns back, for its largest values.
    events += [lambda s, y: y[2], lambda s, y: y[3]]
    solution = solve_ivp(motion, (t, end_s), y, method="DOP853", rtol=tolerance, atol=1e-3 * tolerance,
                         max_step=step_s, events=events)
    run["evaluations"] += solution.nfev
    turned = np.concatenate([solution.y, *(y.T for y in solution.y_events[2:] if len(y))], axis=1)
    for i in (0, 1):
        run["largest"][i] = max(run["largest"][i], float(np.max(np.abs(turned[i]))))
    t, y = solution.t[-1], solution.y[:, -1].copy()
    hit = next((k for k, times in enumerate(solution.t_events[:2]) if len(times)), None)
    if hit is None:
        return t, y, state
    if closing[hit] is None:
        # Just after the force has reached zero, where roundings no longer decide whether the joint opens.
        t, y = t + JUST_AFTER_S, y + JUST_AFTER_S * np.array(motion(t, y))
        return t, y, wall.settled(state, y, ground(t))
    run["impacts"] += 1
    joint = closing[hit]
    if joint == 0:
        y[0] = 0.0
        if not state[1]:
            y[1] = 0.0
    else:
        y[1] = y[0]
    state, y[2:] = wall.impact(joint, state, y)
    return t, y, wall.settled(state, y, ground(t))

