// Elements of higher degree and Gauss collocation with one fault each.
#pragma once

#include <memory>

#include "hamflow/methods/averages.hpp"

namespace hamflow::mutants {

struct AverageFaults {
  std::string name;
  AverageOptions options;
  double wrong_integral = 0;        // relative, of int P_1 up to the first point
  double wrong_value = 0;           // relative, of P_1 at the first point
  bool rounded_one_by_one = false;  // the entries of mu, to 12 binary digits
  double early = 1;                 // Newton takes corrections so many times smaller for what they are

  AverageFaults(const AverageOptions& o) : options(o) {}  // NOLINT: a fault is set afterwards
};

/// The tables of a Setup, changed.
template <class Setup, class Real>
struct FaultySetup : Setup {
  template <class P>
  FaultySetup(const P& problem, const AverageFaults& f) : Setup(problem, f.options), faults(f) {
    auto table = std::make_shared<AverageTable<Real>>(this->table());
    const auto s = static_cast<std::size_t>(table->points);
    if (table->averages > 1) {
      table->inner[s] *= Real(1) + static_cast<Real>(f.wrong_integral);
      table->weight[1] *= Real(1) + static_cast<Real>(f.wrong_value);
    }
    if (f.rounded_one_by_one) {
      for (Real& each : table->inner) {
        const double mu = 0.5 + static_cast<double>(each);
        each = Real(std::nearbyint(mu * 4096) / 4096 - 0.5);
      }
      table->coupling = table->inner;
    }
    changed = table;
    this->table_ = changed.get();
  }
  MethodInfo info() const {
    MethodInfo claims = Setup::info();
    claims.name = faults.name;
    return claims;
  }
  AverageFaults faults;
  std::shared_ptr<const AverageTable<Real>> changed;
};

template <class P, class R>
struct FaultyAverages : NaturalAverages<P, R> {
  using Base = NaturalAverages<P, R>;
  using V = Vector<R, P::dimension>;
  using typename Base::Point;
  using typename Base::Variables;
  using Setup = FaultySetup<typename Base::Setup, R>;
  FaultyAverages(const Setup& setup, const P& problem, const R& h, const V& q0, const V& p0, Effort& effort)
      : Base(setup, problem, h, q0, p0, effort), early(setup.faults.early) {}
  Correction<R> measure(const Variables& x, const Point& at, const Variables& correction) const {
    Correction<R> c = Base::measure(x, at, correction);
    c.size = c.size / static_cast<R>(early);
    return c;
  }
  double early;
};

struct FaultyMethod {
  template <class P>
  static constexpr bool accepts = QuadraticKinetic<P>;
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  AverageFaults faults;
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, FaultyAverages<P, typename A::Real>>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, faults);
  }
};

}  // namespace hamflow::mutants
