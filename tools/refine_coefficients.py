#!/usr/bin/env python3
"""Refines the published coefficients of splitting methods to 40 digits and checks the tables in the tree.

    tools/refine_coefficients.py              prints the digits for the tables
    tools/refine_coefficients.py --check      compares it with include/hamflow/methods

Published digits come from tests/data/coefficients.json; PEFRL's, which has no row there, stand below. What is refined
is the nearest point (Euclidean norm, over the coefficients listed in the table and a composition's middle one) that
meets the order conditions. Coefficients published as exact numbers (EXACT) stay as they are.

The conditions are not transcribed from anywhere but generated:
compositions  a symmetric step of order 2 is exp(h Y1 + h^3 Y3 + h^5 Y5 + ...). The product of the exponentials is
              expanded in words of the letters Y1, Y3, ...; a word with degrees summing to k goes with h^k. A product of
              exponentials is a character of the shuffle algebra, which is the polynomial algebra in the Lyndon words
              [Radford1979]: it equals exp(h Y1) to order p if and only if its coefficients at the Lyndon words up to
              degree p do: 1 at Y1, 0 at all others.
splittings    likewise in words of A (drift) and B (kick), where exp(h (A + B)) has 1/n! at every word of length n.
Nystroem      for q'' = F(q) a splitting is a Runge-Kutta-Nystroem method with Q_j = q + c_j h v +
              h^2 sum_(i<j) b_i (c_j - c_i) F(Q_i); the conditions are those of the special Nystroem trees
              [HNW1993, II.14]. Those of q follow, because the weights there are b_j (1 - c_j).
              Symplecticity makes many of them dependent; Gram-Schmidt leaves those out.
Palindromic methods have even order: only conditions of odd degree are needed.
"""
import json
import math
import re
import sys
from decimal import Decimal, getcontext
from functools import lru_cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DIGITS = 40
getcontext().prec = 110
NUDGE = Decimal("1e-45")  # difference quotients: good to 45 digits, which multiply corrections of at most 1e-13
ENOUGH = Decimal("1e-52")  # the residual at which refining stops: far below 40 digits, far above rounding

COMPOSITIONS = {
    "stv4": "StV4_triple_jump (Forest-Ruth/Candy-Rozmus/Yoshida4)",
    "suzuki4": "Suzuki4_s5",
    "mclachlan4-s5": "McLachlan95_SS5",
    "yoshida6": "Yoshida6A_s7",
    "yoshida6b": "Yoshida6B_s7",
    "yoshida6c": "Yoshida6C_s7",
    "kahan-li6": "KahanLi6_s9odr6a",
    "mclachlan6-s9": "McLachlan95_SS9",
    "sofroniou6": "SofroniouSpaletta05_s13odr6",
    "yoshida8": "Yoshida8D_s15",
    "yoshida8a": "Yoshida8A_s15",
    "yoshida8b": "Yoshida8B_s15",
    "yoshida8c": "Yoshida8C_s15",
    "yoshida8d": "Yoshida8D_s15",
    "yoshida8e": "Yoshida8E_s15",
    "suzuki-umeno8": "Suzuki-Umeno93/McLachlan95_SS15",
    "mclachlan8": "McLachlan95_SS17",
    "kahan-li8": "KahanLi8_s17odr8a",
    "sofroniou8": "SofroniouSpaletta05_s21odr8",
    "kahan-li10": "KahanLi/Hairer s33odr10c (JANUS order 10)",
    "sofroniou10": "SofroniouSpaletta05_s35odr10",
}
SPLITTINGS = {
    "ruth3": "Ruth83_3",
    "mclachlan-s2": "McLachlan95_S2",
    "mcate2": "McLachlanAtela92_2opt",
    "mcate3": "McLachlanAtela92_3opt",
    "mcate4": "McLachlanAtela92_4opt",
    "mcate5": "McLachlanAtela92_5opt",
    "mclachlan-s4": "McLachlan95_S4",
    "mclachlan-s5": "McLachlan95_S5",
    "blanes-moan-s6": "BlanesMoan02_S6",
    "blanes-moan-s10": "BlanesMoan02_S10",
    "sb3a-4": "McLachlan95_SB3A4",
    "sb3a-5": "McLachlan95_SB3A5",
    "calvo-sanz-serna4": "CalvoSanzSerna_4",
    "srkn6b": "BlanesMoan02_SRKN6b",
    "srkn11b": "BlanesMoan02_SRKN11b",
    "srkn14a": "BlanesMoan02_SRKN14a",
    "okunbor-skeel6": "OkunborSkeel94_m13",
    "rkn8-s19": "BlanesCasasEscorihuela22_RKN8_s19",
}
# OmelyanMryglodFolk2002: xi, lambda, chi.
PEFRL = ["0.1786178958448091", "-0.2123418310626054", "-0.06626458266981849"]
# Published as exact numbers, or chosen freely by the authors: by name, expression by position in the table.
EXACT = {
    "mclachlan4-s5": {0: "0.28"},
    "mclachlan6-s9": {0: "0.1867"},
    "mclachlan8": {0: "25/194"},
    "ruth3": {0: "7/24", 1: "2/3", 2: "3/4", 3: "-2/3", 4: "-1/24", 5: "1"},
    "mclachlan-s4": {1: "6/11", 3: "-1/22"},
    "mclachlan-s5": {1: "2/5", 3: "-1/10", 5: "2/5"},
    "sb3a-5": {1: "-3/73", 3: "17/59"},
    "rkn8-s19": {0: "0.0505805", 2: "0.149999"},
}
# Solutions in closed form.
U = "(36+2*sqrt(326))^(1/3)"
CLOSED = {
    "stv4": ["1/(2-2^(1/3))", "1-2/(2-2^(1/3))"],
    "suzuki4": ["1/(4-4^(1/3))", "1/(4-4^(1/3))", "1-4/(4-4^(1/3))"],
    "mcate2": ["1-sqrt(1/2)", "sqrt(1/2)", "sqrt(1/2)", "1-sqrt(1/2)"],
    "sb3a-4": ["1/2-sqrt(7/8)/3", "1", "sqrt(7/8)/3-1/3", "-1/2", "2/3"],
    "mclachlan-s2": [f"1/2-{U}/12+1/(6*{U})", "1/2", f"{U}/6-1/(3*{U})"],
}


# --- words -----------------------------------------------------------------------------------------------------------

@lru_cache(None)
def words(letters, degree):
    """All words of weighted letters (letter, weight) up to a degree, shortest first: (word, weight)."""
    found = [((), 0)]
    for word, weight in found:
        found += [(word + (name,), weight + w) for name, w in letters if weight + w <= degree]
    return found


def is_lyndon(word):
    return len(word) > 0 and all(word < word[k:] for k in range(1, len(word)))


@lru_cache(None)
def endings(letters, degree, alike):
    """For each word the ways to write it as u v: (index of u, weight of v, 1/len(v)!); alike: v repeats this letter."""
    index = {word: k for k, (word, _) in enumerate(words(letters, degree))}
    weights = dict(letters)
    table = []
    for word, _ in words(letters, degree):
        ways = []
        for cut in range(len(word), -1, -1):
            v = word[cut:]
            if alike is not None and any(letter != alike for letter in v):
                break
            ways.append((index[word[:cut]], sum(weights[x] for x in v), Decimal(1) / math.factorial(len(v))))
        table.append(ways)
    return table


def times_exponential(series, ways_of_words, x):
    """series * exp(x A), or series * exp(x Y1 + x^3 Y3 + ...)."""
    powers = [Decimal(1)]
    for _ in range(12):
        powers.append(powers[-1] * x)
    return [sum(series[u] * powers[weight] * factor for u, weight, factor in ways) for ways in ways_of_words]


def composition_conditions(gamma, order):
    degree = order - 1
    letters = tuple((k, k) for k in range(1, degree + 1, 2))
    all_words = words(letters, degree)
    series = [Decimal(1)] + [Decimal(0)] * (len(all_words) - 1)
    for g in gamma:
        series = times_exponential(series, endings(letters, degree, None), g)
    return [c - (1 if word == (1,) else 0)
            for (word, weight), c in zip(all_words, series) if is_lyndon(word) and weight % 2 == 1]


def splitting_conditions(kicks_first, c, order, symmetric):
    degree = order - 1 if symmetric else order
    letters = (("A", 1), ("B", 1))
    all_words = words(letters, degree)
    series = [Decimal(1)] + [Decimal(0)] * (len(all_words) - 1)
    for k, x in enumerate(c):
        series = times_exponential(series, endings(letters, degree, "B" if (k % 2 == 0) == kicks_first else "A"), x)
    return [x - Decimal(1) / math.factorial(weight)
            for (word, weight), x in zip(all_words, series) if is_lyndon(word) and (weight % 2 == 1 or not symmetric)]


# --- special Nystroem trees ------------------------------------------------------------------------------------------

@lru_cache(None)
def trees(order):
    """F(Q) differentiated: (number of arguments v, arguments F as trees); h^order = h^(1 + leaves + 2 other F)."""
    def multisets(budget, largest):
        """Sorted tuples of trees whose h^2 a_ij F cost budget in all: a tree of order m costs m + 1."""
        if budget == 0:
            yield ()
        for m in range(min(budget - 1, largest[0]), 0, -1):
            family = trees(m)
            start = largest[1] if m == largest[0] else len(family) - 1
            for k in range(min(start, len(family) - 1), -1, -1):
                for rest in multisets(budget - m - 1, (m, k)):
                    yield ((m, k),) + rest
    return [(order - 1 - budget, chosen) for budget in range(order) for chosen in multisets(budget, (order, 10**9))]


def nystroem_conditions(kicks_first, c, order, symmetric):
    time, nodes, weights = Decimal(0), [], []
    for k, x in enumerate(c):
        if (k % 2 == 0) == kicks_first:
            nodes.append(time)
            weights.append(x)
        else:
            time += x
    known = {}

    def stage_values(name):  # Phi_j at every stage
        if name not in known:
            leaves, inner = trees(name[0])[name[1]]
            value = [x**leaves if leaves else Decimal(1) for x in nodes]
            for child in inner:
                value = [x * y for x, y in zip(value, kicked(child))]
            known[name] = value
        return known[name]

    def kicked(name):  # sum_(i<j) b_i (c_j - c_i) Phi_i, by sums of b_i Phi_i and b_i c_i Phi_i
        zeroth, first, out = Decimal(0), Decimal(0), []
        for b, x, phi in zip(weights, nodes, stage_values(name)):
            out.append(x * zeroth - first)
            zeroth += b * phi
            first += b * x * phi
        return out

    @lru_cache(None)
    def exact(name):  # Phi_t = factor t^power where sums are integrals: (factor, power)
        leaves, inner = trees(name[0])[name[1]]
        factor, power = Decimal(1), leaves
        for child in inner:
            f, m = exact(child)
            factor, power = factor * f / ((m + 1) * (m + 2)), power + m + 2
        return factor, power

    found = [time - 1]
    for m in range(1, order + 1):
        if symmetric and m % 2 == 0:
            continue
        for k in range(len(trees(m))):
            factor, power = exact((m, k))
            found.append(sum(b * phi for b, phi in zip(weights, stage_values((m, k)))) - factor / (power + 1))
    return found


# --- tables ----------------------------------------------------------------------------------------------------------

class Table:
    """A published set: `listed` coefficients as they stand in the table, with a composition's middle one at the end."""

    def __init__(self, name, row, composition):
        self.name, self.order, self.composition = name, row["order"], composition
        if composition:
            full = row["gamma"]
            self.symmetric = True
        else:
            self.kicks_first = row["starts_with"] == "kick"
            self.nystroem = row["kind"].startswith("Runge-Kutta-Nystroem")
            first, second = ("b_kick", "a_drift") if self.kicks_first else ("a_drift", "b_kick")
            full = [None] * (len(row[first]) + len(row[second]))
            full[0::2], full[1::2] = row[first], row[second]
            self.symmetric = len(full) % 2 == 1 and full == full[::-1]
        self.full_size = len(full)
        self.published = full[:(len(full) + 1) // 2] if self.symmetric else full
        self.texts = list(self.published)
        for position, text in EXACT.get(name, {}).items():
            self.texts[position] = text
        self.texts = CLOSED.get(name, self.texts)
        self.fixed = [name in CLOSED or k in EXACT.get(name, {}) for k in range(len(self.texts))]

    @staticmethod
    def listed(coefficients):
        """What stands in the table."""
        return coefficients

    def conditions(self, listed):
        full = listed + listed[:-1][::-1] if self.symmetric else listed
        if self.composition:
            return composition_conditions(full, self.order)
        if self.nystroem:
            return nystroem_conditions(self.kicks_first, full, self.order, self.symmetric)
        return splitting_conditions(self.kicks_first, full, self.order, self.symmetric)


class Pefrl(Table):
    """An ordinary splitting given by three numbers."""

    def __init__(self):
        self.name, self.order, self.composition, self.symmetric = "pefrl", 4, False, True
        self.kicks_first, self.nystroem, self.full_size = False, False, 9
        self.published = self.texts = PEFRL
        self.fixed = [False] * 3

    @staticmethod
    def listed(parameters):
        xi, kick, chi = parameters
        return [xi, (1 - 2 * kick) / 2, chi, kick, 1 - 2 * (chi + xi)]

    def conditions(self, parameters):
        return super().conditions(self.listed(parameters))


def value_of(text):
    """A decimal, or an expression of numbers, + - * / ^ and sqrt, as the tables have them."""
    in_python = re.sub(r"[0-9.]+", r'number("\g<0>")', str(text).replace("^", "**"))
    return eval(in_python, {"__builtins__": {}, "number": Decimal, "sqrt": Decimal.sqrt})


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def refine(table):
    """The solution nearest to the published one. Each step solves min |y - x0| under F(x) + J (y - x) = 0."""
    start = [value_of(text) for text in table.texts]
    free = [k for k, fixed in enumerate(table.fixed) if not fixed]
    x = list(start)
    table.rank = 0
    for _ in range(8 if free else 0):
        residual = table.conditions(x)
        columns = []
        for k in free:
            y = list(x)
            y[k] += NUDGE
            columns.append([(b - a) / NUDGE for a, b in zip(residual, table.conditions(y))])
        moved = [x[k] - start[k] for k in free]
        rows = [(row, dot(row, moved) - r) for row, r in zip(map(list, zip(*columns)), residual)]
        step, table.rank = least_norm(rows)
        change = max(abs(start[k] + s - x[k]) for k, s in zip(free, step))
        for k, s in zip(free, step):
            x[k] = start[k] + s
        if change < ENOUGH:
            break
    table.residual = max(map(abs, table.conditions(x)))
    table.freedom = len(free) - table.rank
    table.moved = max(abs(a - value_of(b)) for a, b in zip(x, table.published))
    return x


def least_norm(rows):
    """The shortest y with row . y = target for all (row, target), and the number of independent rows. Orthonormal rows
    by Gram-Schmidt, the largest remainder first. Of a dependent row remains what is published wrongly, at most 1e-13;
    the independent ones keep 3e-9 or more."""
    y, rank = [Decimal(0)] * len(rows[0][0]), 0
    while rows:
        squares = [dot(row, row) for row, _ in rows]
        best = max(range(len(rows)), key=squares.__getitem__)
        length = squares[best].sqrt()
        if length < Decimal("1e-11"):
            break
        row, target = rows.pop(best)
        unit, goal = [v / length for v in row], target / length
        y = [a + goal * u for a, u in zip(y, unit)]
        rank += 1
        along = [dot(row, unit) for row, _ in rows]
        rows = [([v - c * u for v, u in zip(row, unit)], t - c * goal) for c, (row, t) in zip(along, rows)]
    return y, rank


def digits(x):
    return format(x.quantize(Decimal(1).scaleb(x.adjusted() - DIGITS + 1)), "f")


def main():
    rows = {row["name"]: row for row in json.loads((ROOT / "tests/data/coefficients.json").read_text())["sets"]}
    tables = [Table(name, rows[row], True) for name, row in COMPOSITIONS.items()]
    tables += [Table(name, rows[row], False) for name, row in SPLITTINGS.items()]
    tables.append(Pefrl())
    check = "--check" in sys.argv[1:]
    wrong = []
    for table in tables:
        refined = refine(table)
        if not table.residual < ENOUGH:
            wrong.append(f"{table.name}: the order conditions are met to {table.residual:.1e} only")
        wanted = [digits(x) for x in table.listed(refined)]
        for k, fixed in enumerate(table.fixed):
            if fixed:
                wanted[k] = table.texts[k]
        if table.composition:
            wanted.pop()  # the middle one is computed
        if check:
            wrong += differences(table, wanted)
            continue
        print(f"{table.name}: order {table.order}, conditions met to {table.residual:.0e}, "
              f"{table.freedom} parameters free, {table.moved:.0e} from the published digits")
        for text in wanted:
            print(f'    "{text}",')
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


def differences(table, wanted):
    folder = "compositions" if table.composition else "splittings"
    path = ROOT / f"include/hamflow/methods/{folder}/{table.name.replace('-', '_')}.hpp"
    if not path.exists():
        return [f"{table.name}: {path} is missing"]
    source = path.read_text()
    alias = re.search(r"\.half = (\w+)\.half", source)
    if alias:
        source = (path.parent / (alias.group(1) + ".hpp")).read_text()
    listed = re.search(r"\.(?:half|coefficients) = \{([^}]*)\}", source)
    found = re.findall(r'"([^"]+)"', listed.group(1)) if listed else []
    if len(found) != len(wanted):
        return [f"{path}: {len(found)} coefficients, {len(wanted)} wanted"]
    return [f"{path}: coefficient {k} is {a}, refined {b}"
            for k, (a, b) in enumerate(zip(found, wanted)) if a != b and not close(a, b)]


def close(found, wanted):
    """More digits than 40 are welcome; a closed form counts by its value."""
    return abs(value_of(found) - value_of(wanted)) <= abs(value_of(wanted)) * Decimal(10) ** (1 - DIGITS)


if __name__ == "__main__":
    sys.exit(main())
