"""The supremum over one polyline of the distance to another, for polylines that are graphs: ordered by their first
coordinate, time. (docs/theory.md, section 7.5.)"""

import math

from painleve._jit import jit

__all__ = ["supremum"]

LEAST_PART = 2.0**-50  # of a piece: where its halving ends, settled or not


@jit
def to_segment(point, Y, k):
    """(distance, place in [0, 1]) of a point to segment k of the polyline Y."""
    along, length = 0.0, 0.0
    for j in range(len(point)):
        edge = Y[k + 1, j] - Y[k, j]
        along += (point[j] - Y[k, j]) * edge
        length += edge * edge
    place = min(max(along / length, 0.0), 1.0) if length > 0.0 else 0.0
    total = 0.0
    for j in range(len(point)):
        difference = point[j] - Y[k, j] - place * (Y[k + 1, j] - Y[k, j])
        total += difference * difference
    return math.sqrt(total), place


@jit
def to_graph(point, Y):
    """(distance, segment) of a point to the polyline Y: outwards from its own instant, while instants are close."""
    last, t = len(Y) - 2, point[0]
    low, high = 0, len(Y)
    while low < high:
        middle = (low + high) // 2
        if Y[middle, 0] < t:
            low = middle + 1
        else:
            high = middle
    left = min(max(low - 1, 0), last)
    right, best, winner = left + 1, math.inf, left
    while (left >= 0 and t - Y[left + 1, 0] < best) or (right <= last and Y[right, 0] - t < best):
        if left >= 0 and t - Y[left + 1, 0] < best:
            distance, _ = to_segment(point, Y, left)
            if distance < best:
                best, winner = distance, left
            left -= 1
        if right <= last and Y[right, 0] - t < best:
            distance, _ = to_segment(point, Y, right)
            if distance < best:
                best, winner = distance, right
            right += 1
    return best, winner


@jit
def supremum(X, Y, width, tiny, attained, foot):
    """(lower, upper) of the supremum over the polyline X of the distance to Y; `attained` and its `foot` are filled."""
    lower, upper = -1.0, 0.0
    for i in range(len(X)):  # all vertices first: a good lower bound settles most pieces at once
        distance, _ = to_graph(X[i], Y)
        if distance > lower:
            lower = distance
            between(X[i], X[i], 0.0, attained)
    for i in range(len(X) - 1):
        lower, bound = over_piece(X[i], X[i + 1], Y, lower, width, tiny, attained)
        upper = max(upper, bound)
    _, winner = to_graph(attained, Y)
    between(Y[winner], Y[winner + 1], to_segment(attained, Y, winner)[1], foot)
    return lower, max(lower, upper)


@jit
def over_piece(start, end, Y, lower, width, tiny, attained):
    """The lower bound, raised by what is found between start and end, and an upper bound for that piece.

    Walks through the halvings of [0, 1] from left to right: a part that is not settled is halved, and after a settled
    one comes the largest part that begins where it ends.
    """
    a, b = start.copy(), start.copy()
    place, part, upper = 0.0, 1.0, 0.0
    at_a, by_a = to_graph(a, Y)
    while place < 1.0:
        between(start, end, place + part, b)
        at_b, by_b = to_graph(b, Y)
        if at_b > lower:
            lower = at_b
            between(b, b, 0.0, attained)
        bound = bound_on_piece(a, b, at_a, at_b, by_a, by_b, Y)
        if bound > lower * (1.0 + width) + tiny and part > LEAST_PART:
            part *= 0.5
            continue
        upper = max(upper, bound)
        place += part
        while place < 1.0 and place % (2.0 * part) == 0.0:
            part *= 2.0
        between(b, b, 0.0, a)
        at_a, by_a = at_b, by_b
    return lower, upper


@jit
def between(start, end, place, out):
    """The point at a place in [0, 1] between start and end."""
    for j in range(len(out)):
        out[j] = start[j] + place * (end[j] - start[j])


@jit
def bound_on_piece(a, b, at_a, at_b, by_a, by_b, Y):
    """An upper bound on the distance to Y over the segment from a to b.

    A distance changes no faster than its point moves; and the distance to one segment of Y is convex.
    """
    length = 0.0
    for j in range(len(a)):
        length += (b[j] - a[j]) ** 2
    bound = 0.5 * (at_a + at_b + math.sqrt(length))
    bound = min(bound, max(at_a, to_segment(b, Y, by_a)[0]))
    return min(bound, max(at_b, to_segment(a, Y, by_b)[0]))
