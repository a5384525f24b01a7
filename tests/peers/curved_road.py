"""Road coordinates of `planners/src/road/centre_line` for CasADi and NumPy.

Only the data of a line and of its edges are shared: polynomials of degree 5 between knots. Here the arc length of the point of
a line that is nearest to a position is a number with an equation, (p(s) - position) . p'(s) = 0.
"""

import casadi as ca
import numpy as np

#: Distance of the places from which the nearest one is chosen to begin a search [m].
SPACING_M = 0.01
#: Newton's steps of a search.
STEPS = 30
#: How far beyond its ends a line is sampled [m].
BEYOND_M = 5.0


def line_table(curve):
    """A row for each polynomial of the centre line and for its straight continuations: arc length from which it holds, arc
    length from which it is counted, coefficients of x and of y, cosine and sine of the heading in the middle, that heading."""
    parts = np.array(curve["line"])
    ends = np.cumsum(parts[:, 0])
    begins = np.concatenate([[0.0], ends[:-1]])

    def tangent(part, u):
        slopes = [np.polynomial.polynomial.polyval(u, np.polynomial.polynomial.polyder(part[i:i + 6])) for i in (1, 7)]
        return np.array(slopes) / np.hypot(*slopes)

    def straight(part, u):
        place = [np.polynomial.polynomial.polyval(u, part[i:i + 6]) for i in (1, 7)]
        slope = [np.polynomial.polynomial.polyval(u, np.polynomial.polynomial.polyder(part[i:i + 6])) for i in (1, 7)]
        return [place[0], slope[0], 0, 0, 0, 0, place[1], slope[1], 0, 0, 0, 0]

    first, last = parts[0], parts[-1]
    coefficients = [straight(first, 0.0), *parts[:, 1:], straight(last, last[0])]
    tangents = [tangent(first, 0.0), *(tangent(part, part[0] / 2) for part in parts), tangent(last, last[0])]
    headings = [np.arctan2(y, x) for x, y in tangents]
    headings = np.unwrap([curve["heading"], *headings])[1:]
    from_m = [-np.inf, *begins, ends[-1]]
    counted_m = [0.0, *begins, ends[-1]]
    return np.array([[a, b, *c, *d, e] for a, b, c, d, e in zip(from_m, counted_m, coefficients, tangents, headings)])


def edge_table(edge):
    """The same for an edge: arc length from which a polynomial holds, arc length from which it is counted, coefficients."""
    (kind, numbers), = edge.items()
    if kind == "constant":
        return np.array([[-np.inf, 0.0, numbers, 0, 0, 0, 0, 0]])
    if kind != "polynomials":
        raise NotImplementedError(f"an edge of kind {kind}")
    parts = np.array(numbers)
    before = [-np.inf, 0.0, parts[0, 2], 0, 0, 0, 0, 0]
    end = np.polynomial.polynomial.polyval(parts[-1, 1] - parts[-1, 0], parts[-1, 2:])
    after = [parts[-1, 1], 0.0, end, 0, 0, 0, 0, 0]
    return np.array([before, *([part[0], part[0], *part[2:]] for part in parts), after])


def project(table, positions):
    """Arc lengths of the points of a line that are nearest to positions [m]."""
    positions = np.atleast_2d(positions)

    def derivatives(along_m, order):
        row = table[np.searchsorted(table[1:, 0], along_m, side="right")]
        u = along_m - row[:, 1]
        found = []
        for first in (2, 8):
            c = row[:, first:first + 6]
            factor = [np.prod(range(k - order + 1, k + 1)) if order else 1 for k in range(6)]
            found.append(sum(factor[k] * c[:, k] * u ** max(k - order, 0) for k in range(order, 6)))
        return np.array(found).T

    samples = np.arange(-BEYOND_M, table[-1, 1] + BEYOND_M, SPACING_M)
    places = derivatives(samples, 0)
    squares = ((positions[:, None, :] - places[None, :, :]) ** 2).sum(axis=2)
    along_m = samples[squares.argmin(axis=1)]
    for _ in range(STEPS):
        apart, first, second = derivatives(along_m, 0) - positions, derivatives(along_m, 1), derivatives(along_m, 2)
        slope = (apart * first).sum(axis=1)
        bend = (first**2).sum(axis=1) + (apart * second).sum(axis=1)
        along_m = along_m - slope / bend
    return along_m


def select(table, along):
    """The row of a symbolic table, whose columns are rows, that holds at an arc length, without its first number."""
    row = [table[i, 0] for i in range(1, table.shape[0])]
    for k in range(1, table.shape[1]):
        holds = along >= table[0, k]
        row = [ca.if_else(holds, table[i + 1, k], value) for i, value in enumerate(row)]
    return row


def polynomial(c, u):
    value, slope = 0, 0
    for k in reversed(range(6)):
        value, slope = value * u + c[k], slope * u + value
    return value, slope


def road_point(table, along, position):
    """The equation of the arc length of a position, the lateral coordinate, and the heading of the line."""
    row = select(table, along)
    u = along - row[0]
    (x, x_slope), (y, y_slope) = polynomial(row[1:7], u), polynomial(row[7:13], u)
    cos, sin, heading = row[13:]
    apart_x, apart_y = position[0] - x, position[1] - y
    across = (x_slope * apart_y - y_slope * apart_x) / ca.sqrt(x_slope**2 + y_slope**2)
    turn = ca.atan((cos * y_slope - sin * x_slope) / (cos * x_slope + sin * y_slope))
    return apart_x * x_slope + apart_y * y_slope, across, heading + turn


def edge(table, along):
    """Lateral coordinate of an edge at an arc length."""
    row = select(table, along)
    return polynomial(row[1:], along - row[0])[0]
