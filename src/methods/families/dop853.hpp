// The explicit Runge-Kutta method of Dormand and Prince of order 8 with sub-steps of its own.
#pragma once

#include <any>

#include "hamflow/methods/dop853.hpp"
#include "methods/adaptive_family.hpp"

namespace hamflow::families {

struct Dop853 {
  static const BoundOptions<AdaptiveOptions>& options() {
    static const auto all = adaptive_options(1);
    return all;
  }

  static MethodFamily declared() {
    MethodFamily family = adaptive_family("dop853", 3, options());
    family.read = [](const Texts& given) { return std::any(read_options(options(), given)); };
    family.describe = [](std::size_t, const Texts& given) {
      MethodInfo info = describe_dop853(read_options(options(), given));
      info.name = canonical_name(info.name, options(), given);
      return info;
    };
    family.meaning = "an explicit Runge-Kutta method of order 8 with adaptive sub-steps, for reference solutions";
    family.advice = [](std::size_t) {
      return MethodAdvice{.take = "you need a reference solution over a few periods, for any differentiable H",
                          .avoid =
                              "the run is long, because its energy drifts: kahan-li8, rkn8-s19, cg; more than 16 "
                              "digits are needed: taylor"};
    };
    family.needs = [](std::size_t) { return "a differentiable H"; };
    family.digits = [](std::size_t) { return dop853::digits; };
    family.hint = [](const Texts&, const UsableAdvice&) { return "try a smaller dt or a larger method.tolerance"; };
    family.measurable = [](const Texts& given) {
      Texts all = given;
      all[options()[1].info.name] = "fixed";
      return all;
    };
    return family;
  }

  template <class F>
  static auto visit(std::size_t, const std::any& given, F&& f) {
    return f(hamflow::Dop853{std::any_cast<const AdaptiveOptions&>(given)});
  }
};

}  // namespace hamflow::families
