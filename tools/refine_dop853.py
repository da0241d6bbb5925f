#!/usr/bin/env python3
"""The coefficients of DOP853 to 70 digits: refines the published ones and writes detail/methods/dop853_tableau.hpp.

Hairer, Norsett and Wanner [HNW1993, II.5] print the coefficients of their code DOP853 to about 30 places. Here they are the
start of a Newton iteration on everything that a coefficient has to satisfy:
  - the nodes, closed in sqrt(6):  c_i = sum_j a_ij;
  - the simplifying assumptions  sum_j a_ij c_j^(m-1) = c_i^m/m  (m = 2, 3 from stage 3 and 4 on, m = 4 from stage 6 on)
    and  sum_i b_i a_ij = b_j (1 - c_j);
  - all 200 order conditions up to order 8, one for each rooted tree.
The solutions are a manifold: each step takes the least change (minimum norm), which gives the solution nearest to the
published digits. The weights of the estimators, then linear, likewise: order 5 on the stages 1, 6..12, order 3 on 1, 9, 12.

usage: python3 tools/refine_dop853.py > include/hamflow/detail/methods/dop853_tableau.hpp
"""

import sys
from decimal import Decimal, getcontext, localcontext
from itertools import combinations_with_replacement

DIGITS = 70
getcontext().prec = 110
ZERO, ONE = Decimal(0), Decimal(1)
STAGES = 12

ROOT6 = Decimal(6).sqrt()
C4 = (6 - ROOT6) / 30
NODES = [ZERO, C4 * 4 / 9, C4 * 2 / 3, C4, (6 + ROOT6) / 30, ONE / 3, ONE / 4, Decimal(4) / 13, Decimal(127) / 195,
         ONE * 3 / 5, Decimal(6) / 7, ONE]

# Published: row i, the columns that are not zero.
PUBLISHED = {
    2: {1: "5.26001519587677318785587544488e-2"},
    3: {1: "1.97250569845378994544595329183e-2", 2: "5.91751709536136983633785987549e-2"},
    4: {1: "2.95875854768068491816892993775e-2", 3: "8.87627564304205475450678981324e-2"},
    5: {1: "2.41365134159266685502369798665e-1", 3: "-8.84549479328286085344864962717e-1",
        4: "9.24834003261792003115737966543e-1"},
    6: {1: "3.7037037037037037037037037037e-2", 4: "1.70828608729473871279604482173e-1",
        5: "1.25467687566822425016691814123e-1"},
    7: {1: "3.7109375e-2", 4: "1.70252211019544039314978060272e-1", 5: "6.02165389804559606850219397283e-2",
        6: "-1.7578125e-2"},
    8: {1: "3.70920001185047927108779319836e-2", 4: "1.70383925712239993810214054705e-1",
        5: "1.07262030446373284651809199168e-1", 6: "-1.53194377486244017527936158236e-2",
        7: "8.27378916381402288758473766002e-3"},
    9: {1: "6.24110958716075717114429577812e-1", 4: "-3.36089262944694129406857109825",
        5: "-8.68219346841726006818189891453e-1", 6: "2.75920996994467083049415600797e1",
        7: "2.01540675504778934086186788979e1", 8: "-4.34898841810699588477366255144e1"},
    10: {1: "4.77662536438264365890433908527e-1", 4: "-2.48811461997166764192642586468",
         5: "-5.90290826836842996371446475743e-1", 6: "2.12300514481811942347288949897e1",
         7: "1.52792336328824235832596922938e1", 8: "-3.32882109689848629194453265587e1",
         9: "-2.03312017085086261358222928593e-2"},
    11: {1: "-9.3714243008598732571704021658e-1", 4: "5.18637242884406370830023853209",
         5: "1.09143734899672957818500254654", 6: "-8.14978701074692612513997267357",
         7: "-1.85200656599969598641566180701e1", 8: "2.27394870993505042818970056734e1",
         9: "2.49360555267965238987089396762", 10: "-3.0467644718982195003823669022"},
    12: {1: "2.27331014751653820792359768449", 4: "-1.05344954667372501984066689879e1",
         5: "-2.00087205822486249909675718444", 6: "-1.79589318631187989172765950534e1",
         7: "2.79488845294199600508499808837e1", 8: "-2.85899827713502369474065508674",
         9: "-8.87285693353062954433549289258", 10: "1.23605671757943030647266201528e1",
         11: "6.43392746015763530355970484046e-1"},
}
PUBLISHED_B = {1: "5.42937341165687622380535766363e-2", 6: "4.45031289275240888144113950566",
               7: "1.89151789931450038304281599044", 8: "-5.8012039600105847814672114227",
               9: "3.1116436695781989440891606237e-1", 10: "-1.52160949662516078556178806805e-1",
               11: "2.01365400804030348374776537501e-1", 12: "4.47106157277725905176885569043e-2"}
# b - b^ of the estimator of order 5, and b^^ of the one of order 3.
PUBLISHED_E5 = {1: "0.1312004499419488073250102996e-1", 6: "-0.1225156446376204440720569753e1",
                7: "-0.4957589496572501915214079952", 8: "0.1664377182454986536961530415e1",
                9: "-0.3503288487499736816886487290", 10: "0.3341791187130174790297318841",
                11: "0.8192320648511571246570742613e-1", 12: "-0.2235530786388629525884427845e-1"}
PUBLISHED_B3 = {1: "0.244094488188976377952755905512", 9: "0.733846688281611857341361741547",
                12: "0.220588235294117647058823529412e-1"}

# The unknowns: (row, column) of a, and (0, column) of b.
UNKNOWNS = [(i, j) for i, row in PUBLISHED.items() for j in row] + [(0, j) for j in PUBLISHED_B]
INDEX = {place: k for k, place in enumerate(UNKNOWNS)}
N = len(UNKNOWNS)


def partitions(total, most):
    """The non-increasing sequences of positive numbers that add up to total."""
    if total == 0:
        yield []
    for first in range(min(total, most), 0, -1):
        for rest in partitions(total - first, first):
            yield [first] + rest


def rooted_trees(order):
    """forest[n]: every rooted tree with n nodes, as the tuple of its subtrees."""
    trees = {1: [()]}
    for n in range(2, order + 1):
        trees[n] = []
        for sizes in partitions(n - 1, n - 1):
            choices = [()]
            for size in sorted(set(sizes)):
                picks = list(combinations_with_replacement(trees[size], sizes.count(size)))
                choices = [c + p for c in choices for p in picks]
            trees[n] += choices
    return trees


def nodes_of(tree):
    return 1 + sum(nodes_of(t) for t in tree)


def density(tree):
    """gamma(t) = |t| times the densities of the subtrees.   [HNW1993, II.2, def. 2.10]"""
    product = nodes_of(tree)
    for t in tree:
        product *= density(t)
    return product


class Number:
    """A value and its derivatives by the unknowns, only those that are not zero."""
    __slots__ = ("value", "slope")

    def __init__(self, value, slope=None):
        self.value, self.slope = value, slope or {}

    def __add__(self, other):
        slope = dict(self.slope)
        for k, s in other.slope.items():
            slope[k] = slope.get(k, ZERO) + s
        return Number(self.value + other.value, slope)

    def __mul__(self, other):
        slope = {k: s * other.value for k, s in self.slope.items()}
        for k, s in other.slope.items():
            slope[k] = slope.get(k, ZERO) + s * self.value
        return Number(self.value * other.value, slope)

    def minus(self, constant):
        return Number(self.value - constant, self.slope)


class Tableau:
    """The unknowns as numbers with derivatives."""

    def __init__(self, x):
        unknown = [Number(x[k], {k: ONE}) for k in range(N)]
        self.a = [[(j, unknown[INDEX[i, j]]) for j in PUBLISHED[i]] if i > 1 else [] for i in range(1, STAGES + 1)]
        self.b = {j: unknown[INDEX[0, j]] for j in PUBLISHED_B}
        self.weights = {}

    def stage_sum(self, vector):
        """(A v)_i."""
        sums = []
        for row in self.a:
            total = Number(ZERO)
            for j, a in row:
                total = total + a * vector[j - 1]
            sums.append(total)
        return sums

    def weight(self, tree):
        """The elementary weights of the stages, Phi_i(t) = prod over subtrees of (A Phi(t'))_i."""
        product = [Number(ONE)] * STAGES
        for subtree in tree:
            if subtree not in self.weights:
                self.weights[subtree] = self.stage_sum(self.weight(subtree))
            product = [p * w for p, w in zip(product, self.weights[subtree])]
        return product

    def order_conditions(self, order):
        for trees in rooted_trees(order).values():
            for tree in trees:
                phi = self.weight(tree)
                total = Number(ZERO)
                for j, b in self.b.items():
                    total = total + b * phi[j - 1]
                yield total.minus(ONE / density(tree))

    def simplifying(self):
        for power, first in ((1, 2), (2, 3), (3, 4), (4, 6)):
            sums = self.stage_sum([Number(c**(power - 1)) for c in NODES] if power > 1 else [Number(ONE)] * STAGES)
            for i in range(first - 1, STAGES):
                yield sums[i].minus(NODES[i]**power / power)
        for j in range(4, STAGES + 1):
            total = Number(ZERO)
            for i in range(j + 1, STAGES + 1):
                if i in self.b and (i, j) in INDEX:
                    total = total + self.b[i] * Number(self.a[i - 1][[k for k, _ in self.a[i - 1]].index(j)][1].value,
                                                       {INDEX[i, j]: ONE})
            right = self.b[j] * Number(NODES[j - 1] - 1) if j in self.b else Number(ZERO)
            yield total + right


def least_change(equations, width):
    """The smallest dx with J dx = -F, for equations of which many depend on others: rows are orthogonalised, largest
    first, until what is left is the noise of a rank that is not full. Also the gap that shows the rank."""
    rows = []
    for e in equations:
        row = [ZERO] * width
        for k, s in e.slope.items():
            row[k] = s
        rows.append((row, -e.value))
    basis, dx = [], [ZERO] * width
    smallest = largest_left = None
    while rows:
        sizes = [sum(v * v for v in row) for row, _ in rows]
        best = max(range(len(rows)), key=sizes.__getitem__)
        if sizes[best] < Decimal("1e-36"):
            largest_left = sizes[best].sqrt()
            break
        smallest = sizes[best].sqrt()
        row, right = rows.pop(best)
        scale = sizes[best].sqrt()
        unit, right = [v / scale for v in row], right / scale
        basis.append(unit)
        dx = [x + right * u for x, u in zip(dx, unit)]
        reduced = []
        for other, value in rows:
            factor = sum(u * v for u, v in zip(unit, other) if v)
            if factor:
                other = [v - factor * u for u, v in zip(unit, other)]
                value = value - factor * right
            reduced.append((other, value))
        rows = reduced
    return dx, len(basis), smallest, largest_left


def size(equations):
    return max(abs(e.value) for e in equations)


def refine():
    published = [Decimal(PUBLISHED[i][j]) if i else Decimal(PUBLISHED_B[j]) for i, j in UNKNOWNS]
    x = list(published)
    for iteration in range(12):
        tableau = Tableau(x)
        equations = list(tableau.simplifying()) + list(tableau.order_conditions(8))
        residual = size(equations)
        dx, rank, smallest, left = least_change(equations, N)
        change = max(abs(d) for d in dx)
        print(f"Newton {iteration}: residual {residual:.1e}, rank {rank} of {N} (smallest {smallest:.1e}, left {left or 0:.1e}),"
              f" change {change:.1e}", file=sys.stderr)
        x = [v + d for v, d in zip(x, dx)]
        if residual < Decimal(10)**-(DIGITS + 20):
            break
    moved = max(abs(v - p) for v, p in zip(x, published))
    print(f"moved by {moved:.1e} from the published digits", file=sys.stderr)
    return x


def refine_weights(start, b, x, order):
    """The weights nearest to `start` on its stages that meet the order conditions."""
    stages = list(start)
    tableau = Tableau(x)
    equations = []
    for trees in rooted_trees(order).values():
        for tree in trees:
            phi = tableau.weight(tree)
            value = sum(start[j] * phi[j - 1].value for j in stages) - ONE / density(tree)
            equations.append(Number(value, {k: phi[j - 1].value for k, j in enumerate(stages)}))
    dx, rank, _, _ = least_change(equations, len(stages))
    print(f"order {order}: residual {size(equations):.1e}, rank {rank} of {len(stages)},"
          f" change {max(abs(d) for d in dx):.1e}", file=sys.stderr)
    return {j: start[j] + d for j, d in zip(stages, dx)}


def digits_kept(x):
    """The largest residual once the coefficients are rounded as they are printed."""
    with localcontext() as rounding:
        rounding.prec = DIGITS
        printed = [+v for v in x]
    tableau = Tableau(printed)
    return max(size(list(tableau.simplifying())), size(list(tableau.order_conditions(8))))


def text(value):
    with localcontext() as rounding:
        rounding.prec = DIGITS
        rounded = format(+value, "f")
    return f'"{rounded}"'


HEADER = """// Generated by tools/refine_dop853.py. The coefficients of DOP853 (Dormand and Prince 8(5,3)), refined to {digits} digits.
// [HNW1993, II.5, and the code DOP853]
// Stages count from 0 here; the rows hold what is not zero.
#pragma once

#include <array>
#include <string_view>

namespace hamflow::dop853 {{

inline constexpr int digits = {digits};  // to which the order conditions hold
inline constexpr std::size_t stages = 12;

struct Entry {{
  std::size_t row;     // stage
  std::size_t column;  // earlier stage
  std::string_view value;
}};
struct Weight {{
  std::size_t stage;
  std::string_view value;
}};
"""


def main():
    x = refine()
    print(f"rounded to {DIGITS} digits: residual {digits_kept(x):.1e}", file=sys.stderr)
    b = {j: x[INDEX[0, j]] for j in PUBLISHED_B}
    fifth = refine_weights({j: b[j] - Decimal(PUBLISHED_E5[j]) for j in PUBLISHED_B}, b, x, 5)
    third = refine_weights({j: Decimal(v) for j, v in PUBLISHED_B3.items()}, b, x, 3)
    out = [HEADER.format(digits=DIGITS)]
    inner = [(i, j) for i, j in UNKNOWNS if i]
    out.append("// clang-format off")
    out.append(f"inline constexpr std::array<Entry, {len(inner)}> a{{{{")
    out += [f"    {{{i - 1}, {j - 1}, {text(x[INDEX[i, j]])}}}," for i, j in inner]
    out.append("}};")

    def weights(name, meaning, values):
        out.append(f"/// {meaning}")
        out.append(f"inline constexpr std::array<Weight, {len(values)}> {name}{{{{")
        out.extend(f"    {{{j - 1}, {text(v)}}}," for j, v in values.items())
        out.append("}};")

    weights("b", "Order 8.", b)
    weights("error5", "b minus the weights of a formula of order 5.", {j: b[j] - fifth[j] for j in b})
    weights("error3", "b minus the weights of a formula of order 3.", {j: b[j] - third.get(j, ZERO) for j in b})
    out.append("// clang-format on\n\n}  // namespace hamflow::dop853")
    print("\n".join(out))


if __name__ == "__main__":
    main()
