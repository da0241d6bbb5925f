#include "emission.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "hamflow/core/error.hpp"

namespace hamflow::formula {

int Emission::value(int form, bool negated) {
  const Signed s = of_form(form);
  return plain({s.node, s.negative != negated});
}

int Emission::scaled_value(int form, int symbol, bool negated) {
  const Form& f = forms_[form];
  if (f.terms.empty()) return number(0);
  const Signed s = of_term(f.terms.at(0), -1, out_.symbol(symbol));
  return plain({s.node, s.negative != negated});
}

Signed Emission::of_form(int form) {
  if (const auto known = known_.find(form); known != known_.end()) return known->second;
  if (++depth_ > 1000) throw Error("found functions nested more than 1000 deep; allowed at most 1000");
  const Terms terms = forms_[form].terms;  // a copy, because adding forms moves them in memory
  const Signed s = of_sum(terms);
  --depth_;
  known_.emplace(form, s);
  return s;
}

Signed Emission::added(const std::vector<Signed>& parts) {
  Signed total = parts.at(0);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const bool same = parts[i].negative == total.negative;
    total.node = out_.node(same ? Op::add : Op::subtract, total.node, parts[i].node);
  }
  return total;
}

Signed Emission::of_sum(const Terms& terms) {
  if (terms.empty()) return {number(0)};
  if (terms.size() == 1) return of_term(terms[0]);
  if (const auto s = of_one_base(terms)) return *s;
  // Groups are in the order of their first terms.
  std::vector<std::pair<std::string, Terms>> groups;
  for (const Term& term : terms) {
    std::string key;
    int base = -1;
    std::size_t bases = 0;
    Rational degree{0, 1};
    bool polynomial = true;
    for (const Factor& f : term.factors) {
      if (forms_.is_constant(f)) continue;
      ++bases;
      base = f.base;
      polynomial = polynomial && is_variable(f.base) && f.exponent.is_whole() && f.exponent.up > 0;
      if (polynomial) degree.up += f.exponent.up;
    }
    if (polynomial) {
      key = "degree " + std::to_string(degree.up);
    } else if (bases == 1 && !is_variable(base)) {
      key = "base " + std::to_string(base);
    }
    const auto same =
        std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return !key.empty() && g.first == key; });
    if (same == groups.end()) {
      groups.push_back({key, {term}});
    } else {
      same->second.push_back(term);
    }
  }
  std::vector<Signed> parts;
  for (const auto& [key, of_key] : groups) parts.push_back(of_group(of_key));
  return added(parts);
}

/// Emits a sum of terms of equal degree, or of powers of one base, with their common factors before it.
Signed Emission::of_group(const Terms& terms) {
  if (terms.size() == 1) return of_term(terms[0]);
  if (const auto s = of_one_base(terms)) return *s;
  Terms rest = terms;
  const Term common = extracted(rest);
  std::vector<Signed> parts;
  for (const Term& term : rest) parts.push_back(of_term(term));
  const Signed inside = added(parts);
  const Signed all = of_term(common, inside.node);
  return {all.node, all.negative != inside.negative};
}

/// Divides all terms by their common factors, and returns these.
Term Emission::extracted(Terms& terms) {
  Term common;
  const Rational first = terms[0].c;
  if (std::all_of(terms.begin(), terms.end(), [&](const Term& t) { return t.c == first || t.c == -first; })) {
    common.c = first.up < 0 ? -first : first;
  } else if (std::all_of(terms.begin(), terms.end(), [](const Term& t) { return t.c.is_whole(); })) {
    std::int64_t divisor = 0;
    for (const Term& t : terms) divisor = std::gcd(divisor, t.c.up);
    common.c = {divisor, 1};
  }
  for (const Factor& f : terms[0].factors) {
    const bool constant = forms_.is_constant(f);
    std::optional<Rational> least;
    for (const Term& t : terms) {
      const auto own =
          std::find_if(t.factors.begin(), t.factors.end(), [&](const Factor& g) { return g.base == f.base; });
      const bool fits = own != t.factors.end() &&
                        (constant ? own->exponent == f.exponent : is_variable(f.base) && own->exponent.is_whole());
      if (!fits) {
        least.reset();
        break;
      }
      if (!least || own->exponent.up < least->up) least = own->exponent;
    }
    if (least && (constant || least->up > 0)) common.factors.push_back({f.base, *least});
  }
  for (Term& t : terms) {
    t.c = *fraction(static_cast<Wide>(t.c.up) * common.c.down, static_cast<Wide>(t.c.down) * common.c.up);
    for (const Factor& f : common.factors) {
      for (Factor& own : t.factors) {
        if (own.base == f.base) own.exponent = *formula::sum(own.exponent, -f.exponent);
      }
    }
    std::erase_if(t.factors, [](const Factor& g) { return g.exponent.is_zero(); });
  }
  return common;
}

/// Emits a sum of powers of one base by Horner's scheme, if the exponents differ by whole numbers; else nullopt.
std::optional<Signed> Emission::of_one_base(const Terms& terms) {
  int base = -1;
  bool negative = true;
  std::optional<Rational> some;
  for (const Term& term : terms) {
    Rational exponent{0, 1};
    for (const Factor& f : term.factors) {
      if (forms_.is_constant(f)) continue;
      if ((base >= 0 && base != f.base) || !exponent.is_zero()) return std::nullopt;
      base = f.base;
      exponent = f.exponent;
    }
    negative = negative && exponent.is_whole() && exponent.up < 0;
    if (!some) some = exponent;
    const auto gap = formula::sum(exponent, -*some);
    if (!gap || !gap->is_whole() || gap->up > 1000 || gap->up < -1000) return std::nullopt;
  }
  if (base < 0) return std::nullopt;
  return negative ? inverse_powers(base, terms) : nested(base, terms);
}

namespace {
Rational exponent_of(const Term& term, int base) {
  for (const Factor& f : term.factors) {
    if (f.base == base) return f.exponent;
  }
  return {0, 1};
}
Term without(Term term, int base) {
  std::erase_if(term.factors, [&](const Factor& f) { return f.base == base; });
  return term;
}
}  // namespace

Signed Emission::nested(int base, const Terms& terms) {
  Terms sorted = terms;
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Term& a, const Term& b) {
    const Rational x = exponent_of(a, base);
    const Rational y = exponent_of(b, base);
    return static_cast<Wide>(x.up) * y.down < static_cast<Wide>(y.up) * x.down;
  });
  const Rational lowest = exponent_of(sorted[0], base);
  std::vector<Rational> exponents;
  for (const Term& t : sorted) exponents.push_back(exponent_of(t, base));
  for (Term& t : sorted) t = without(t, base);
  const Term common = extracted(sorted);
  // sum = c_0 + B^gap (c_1 + ...)
  std::size_t k = sorted.size() - 1;
  Coefficient last = coefficient(sorted[k]);
  Signed inner{-1};
  while (k-- > 0) {
    const Rational gap = *formula::sum(exponents[k + 1], -exponents[k]);
    const Coefficient own = coefficient(sorted[k]);
    Signed product_{-1};
    if (gap.is_zero()) {  // like terms with coefficients that could not be added as fractions
      product_ = inner.node < 0 ? as_node(last) : inner;
    } else {
      const Signed step = power(base, gap);
      product_ = inner.node < 0 ? times(last, step.node)
                                : Signed{out_.node(Op::multiply, step.node, inner.node), inner.negative};
      product_.negative = product_.negative != step.negative;
    }
    inner = added({as_node(own), product_});
  }
  Term outside = common;
  if (!lowest.is_zero()) outside.factors.push_back({base, lowest});
  const Signed all = of_term(outside, inner.node);
  return {all.node, all.negative != inner.negative};
}

Signed Emission::inverse_powers(int base, const Terms& terms) {
  std::int64_t gap = 0;
  const std::int64_t first = -exponent_of(terms[0], base).up;
  for (const Term& t : terms) gap = std::gcd(gap, -exponent_of(t, base).up - first);
  if (gap == 0) return nested(base, terms);
  const std::int64_t rest = first % gap;
  // 1/B^gap, computed from 1/B^2 if gap is even
  const Signed b = of_base(base);
  const bool even = gap % 2 == 0;
  const int one_over = out_.node(Op::divide, number(1), even ? whole_power(b.node, 2) : b.node);
  int step = one_over;
  for (std::int64_t k = 1; k < (even ? gap / 2 : gap); ++k) step = out_.node(Op::multiply, step, one_over);
  const bool odd_sign = b.negative && !even;
  Terms constants;
  for (const Term& t : terms) constants.push_back(without(t, base));
  const Term common = extracted(constants);
  std::vector<Signed> parts;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const std::int64_t count = (-exponent_of(terms[i], base).up - rest) / gap;
    const Coefficient c = coefficient(constants[i]);
    Signed part = count == 0 ? as_node(c) : times(c, whole_power(step, count));
    part.negative = part.negative != (odd_sign && count % 2 != 0);
    parts.push_back(part);
  }
  const Signed inside = added(parts);
  Signed all = of_term(common, inside.node);
  if (rest > 0) {
    const Signed below = power(base, {rest, 1});
    all.node = out_.node(Op::divide, all.node, below.node);
    all.negative = all.negative != below.negative;
  }
  return {all.node, all.negative != inside.negative};
}

Emission::Coefficient Emission::coefficient(const Term& term) {
  Coefficient c;
  c.negative = term.c.up < 0;
  const std::int64_t up = term.c.up < 0 ? -term.c.up : term.c.up;
  const std::int64_t down = term.c.down;
  int above = up == 1 ? -1 : number(up);
  int below = -1;
  bool others = false;
  for (const Factor& f : term.factors) {
    if (!forms_.is_constant(f)) continue;
    if (!others && down != 1) below = number(down);
    others = true;
    const Rational size = f.exponent.up < 0 ? -f.exponent : f.exponent;
    int& side = f.exponent.up < 0 ? below : above;
    if (size.is_whole() && size.up <= 4) {  // a short power is multiplied factor by factor, as in m l l
      const Signed b = of_base(f.base);
      for (std::int64_t k = 0; k < size.up; ++k) {
        side = product(side, b.node);
        c.negative = c.negative != b.negative;
      }
    } else {
      const Signed p = power(f.base, size);
      side = product(side, p.node);
      c.negative = c.negative != p.negative;
    }
  }
  if (!others) {
    const bool exact = std::has_single_bit(static_cast<std::uint64_t>(down));  // its reciprocal is exact
    if (up == 1 && !exact) {
      c.divisor = down;
      return c;
    }
    if (down != 1) below = number(down);
  }
  if (below >= 0) {
    c.node = out_.node(Op::divide, above < 0 ? number(1) : above, below);
  } else {
    c.node = above;
  }
  return c;
}

Signed Emission::times(const Coefficient& c, int node) {
  int all = product(c.node, node);
  if (c.divisor != 1) all = out_.node(Op::divide, all, number(c.divisor));
  return {all, c.negative};
}

Signed Emission::as_node(const Coefficient& c) {
  const int node = c.node < 0 ? number(1) : c.node;
  return {c.divisor == 1 ? node : out_.node(Op::divide, node, number(c.divisor)), c.negative};
}

/// Emits a term.   @param inside the node of a further factor   @param scale a node that multiplies the constant
Signed Emission::of_term(const Term& term, int inside, int scale) {
  Coefficient c = coefficient(term);
  if (scale >= 0) c.node = product(scale, c.node);
  bool negative = c.negative;
  int functions_above = inside;
  int functions_below = -1;
  int coordinates_below = -1;
  bool functions = false;
  std::vector<int> coordinates;
  for (const Factor& f : term.factors) {
    if (forms_.is_constant(f)) continue;
    const bool below = f.exponent.up < 0;
    const Signed p = power(f.base, below ? -f.exponent : f.exponent);
    negative = negative != p.negative;
    if (!is_variable(f.base)) {
      functions = functions || below;
      int& side = below ? functions_below : functions_above;
      side = product(side, p.node);
    } else if (below) {
      coordinates_below = product(coordinates_below, p.node);
    } else {
      coordinates.push_back(p.node);
    }
  }
  // constant, functions; over functions; times coordinates; over coordinates
  if (functions) {
    functions_below = product(functions_below, coordinates_below);
    coordinates_below = -1;
  }
  int all = product(c.node, functions_above);
  const auto divide = [&](int below) {
    if (below >= 0) all = out_.node(Op::divide, all < 0 ? number(1) : all, below);
  };
  divide(functions_below);
  for (const int coordinate : coordinates) all = product(all, coordinate);
  divide(coordinates_below);
  if (all < 0) all = number(1);
  if (c.divisor != 1) all = out_.node(Op::divide, all, number(c.divisor));
  return {all, negative};
}

Signed Emission::power(int base, const Rational& exponent) {
  const Signed b = of_base(base);
  if (exponent.is(1)) return b;
  if (exponent.is_whole() && exponent.up <= 64) {
    return {whole_power(b.node, exponent.up), b.negative && exponent.up % 2 != 0};
  }
  const int node = plain(b);
  if (exponent.down == 2 && exponent.up <= 128) {  // u^2 sqrt(u)
    const int root = out_.node(Op::sqrt, node);
    const std::int64_t whole = exponent.up / 2;
    return {whole == 0 ? root : out_.node(Op::multiply, whole_power(node, whole), root)};
  }
  const int up = number(exponent.up);
  return {out_.node(Op::power, node, exponent.is_whole() ? up : out_.node(Op::divide, up, number(exponent.down)))};
}

int Emission::whole_power(int node, std::int64_t n) {
  if (n == 1) return node;
  const int half = whole_power(node, n / 2);
  const int even = out_.node(Op::multiply, half, half);
  return n % 2 == 1 ? out_.node(Op::multiply, even, node) : even;
}

Signed Emission::of_base(int index) {
  const Base b = forms_.base_at(index);
  switch (b.kind) {
    case Base::Kind::symbol:
      return {out_.symbol(b.a)};
    case Base::Kind::number:
      return {out_.number(forms_.graph().text(forms_.graph()[b.a]))};
    case Base::Kind::pi:
      return {out_.node(Op::pi)};
    case Base::Kind::group:
      return of_form(b.a);
    case Base::Kind::power:
      return {out_.node(Op::power, value(b.a), value(b.b))};
    case Base::Kind::function:
      break;
  }
  if (b.b >= 0) {
    const int y = value(b.a);
    return {out_.node(b.op, y, value(b.b))};
  }
  return {out_.node(b.op, value(b.a))};
}

}  // namespace hamflow::formula
