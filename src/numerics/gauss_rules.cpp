#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow::detail {

namespace {
template <class R>
GaussRule<R> from_more_digits(int s) {
  constexpr int digits = 45;  // ten more than quad has
  const MpDigits scope(digits);
  const GaussRule<Mp> fine = make_gauss_rule<Mp>(s);
  GaussRule<R> rule{s, {}, {}, {}};
  const auto round = [](const std::vector<Mp>& from, std::vector<R>& to) {
    for (const Mp& x : from) to.push_back(parse_decimal<R>(written_digits(x)));
  };
  round(fine.c, rule.c);
  round(fine.offset, rule.offset);
  round(fine.b, rule.b);
  return rule;
}
}  // namespace

template <>
GaussRule<DoubleDouble> make_gauss_rule<DoubleDouble>(int s) {
  return from_more_digits<DoubleDouble>(s);
}
template <>
GaussRule<Quad> make_gauss_rule<Quad>(int s) {
  return from_more_digits<Quad>(s);
}

}  // namespace hamflow::detail
