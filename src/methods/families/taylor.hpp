// Taylor series by automatic differentiation with sub-steps of its own.
#pragma once

#include <any>

#include "hamflow/methods/taylor.hpp"
#include "methods/adaptive_family.hpp"

namespace hamflow::families {

struct Taylor {
  static const BoundOptions<AdaptiveOptions>& options() {
    static const auto all = [] {
      BoundOptions<AdaptiveOptions> list = adaptive_options(2);
      list.insert(list.begin(), bind_number({.name = "order",
                                             .meaning = "order of the series",
                                             .range = Range::whole_from(2, 200),
                                             .unset = "the cheapest for the tolerance",
                                             .example = "20",
                                             .position = 1},
                                            &AdaptiveOptions::order));
      return list;
    }();
    return all;
  }

  static MethodFamily declared() {
    MethodFamily family = adaptive_family("taylor", 4, options());
    family.read = [](const Texts& given) { return std::any(read_options(options(), given)); };
    family.describe = [](std::size_t, const Texts& given) {
      const AdaptiveOptions read = read_options(options(), given);
      MethodInfo info = describe_taylor(read, taylor_order(read));
      info.name = canonical_name(info.name, options(), given);
      return info;
    };
    family.counts_forces = false;  // a pass over the tape of series is not a force evaluation
    family.meaning = "Taylor series with adaptive sub-steps, for reference solutions in any number of digits";
    family.advice = [](std::size_t) {
      return MethodAdvice{
          .purpose = "reference solutions, in any number of digits (arithmetic quad, mp(d)); any analytic H",
          .take = "the solution itself must be accurate to many digits, over a limited time",
          .avoid =
              "the run is long, because nothing is conserved by construction: kahan-li8, rkn8-s19 for H = T(p) + V(q), "
              "cg for any H"};
    };
    family.needs = [](std::size_t) { return "an H whose derivatives can be recorded"; };
    family.hint = [](const Texts&, const UsableAdvice&) {
      return "try a smaller dt, a larger method.tolerance or another method.order";
    };
    // With order 15, the default, the error cannot be halved four times in any available arithmetic.
    family.measurable = [](const Texts& given) {
      Texts all = given;
      all.try_emplace(options()[0].info.name, "8");
      all[options()[2].info.name] = "fixed";
      return all;
    };
    return family;
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    return f(hamflow::Taylor{std::any_cast<const AdaptiveOptions&>(given)});
  }
};

}  // namespace hamflow::families
