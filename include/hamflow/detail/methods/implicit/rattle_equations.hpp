// The equations of one step of RATTLE, H = p^T M^-1 p/2 + V(q) with g(q) = 0:   [HLW2006, Sect. VII.1.4, (1.26)]
//     P  = p0 - h/2 V'(q0) - g'(q0)^T lambda,    q1 = q0 + h M^-1 P,    g(q1) = 0,
//     p1 = P - h/2 V'(q1) - g'(q1)^T mu,         g'(q1) M^-1 p1 = 0,
// with multipliers in units of a momentum. Newton's method solves only for lambda; mu solves linear equations. The
// equation is (g' M^-1 g'^T)(q0)^-1 g(q1)/h = 0, so that the correction of lambda is about the residual and every
// iteration can be used.
#pragma once

#include <optional>

#include "hamflow/core/constraints.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/detail/methods/implicit/equations.hpp"
#include "hamflow/detail/numerics/lu_factors.hpp"

namespace hamflow {

template <class P, class R>
class RattleEquations {
 public:
  using Problem = P;
  using Real = R;
  static constexpr std::size_t n = P::dimension;
  using V = Vector<Real, n>;
  using Rows = Gradients<Real, n>;
  using Variables = Vector<Real, dynamic>;  // lambda
  using Unknowns = Variables;               // q1 - q0, p1 - p0, lambda, mu
  using Memory = Variables;

  class Setup {
   public:
    static constexpr const char* residual_name = "|g|";
    Setup(const P& problem, const NewtonOptions& options) : options_(options), size_(degrees_of_freedom(problem)) {}
    MethodInfo info() const { return {}; }  // Rattle has the info
    NewtonOptions newton() const { return options_; }
    std::string detail() const { return "a multiplier for each constraint"; }
    template <class Archive>
    void archive(Archive&) {}
    template <std::size_t N, class S>
    Increment<S, N> increment(const Vector<S, dynamic>& unknowns) const {
      Increment<S, N> z{zeros<S, N>(size_), zeros<S, N>(size_)};
      for (std::size_t i = 0; i < size_; ++i) {
        z.q[i] = unknowns[i];
        z.p[i] = unknowns[size_ + i];
      }
      return z;
    }

   private:
    NewtonOptions options_;
    std::size_t size_;
  };

  /// The values at one lambda.
  struct Point {
    Variables residual{};
    bool linearised = true;
    Matrix<Real, dynamic> tangent{};
    Variables g{};     // g(q1)
    Variables size{};  // sizes of the terms of g(q1)
    V impulse{};       // P - p0
    V moved{};         // q1 - q0
    V position{};      // q1
    Rows rows{};       // g'(q1)
  };

  RattleEquations(const Setup&, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : problem_(problem), h_(h), q0_(q0), p0_(p0), effort_(effort) {}

  /// The multipliers without the curvature of the constraints.
  Variables predicted() const {
    const Begin& begin = this->begin();
    return multipliers(begin.rows, begin.with_mass, products(begin.rows, inverse_mass_times(problem_, begin.kicked)));
  }
  Variables last_state() const { return predicted(); }
  Variables started(const Memory& extrapolated) const { return extrapolated; }

  void evaluate(const Variables& lambda, Point& at) const {
    const Begin& begin = this->begin();
    at.impulse = begin.kick;
    V sizes = begin.kicked;
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = abs(sizes[i]);
    for (std::size_t k = 0; k < lambda.size(); ++k) {
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        at.impulse[i] -= begin.rows[k][i] * lambda[k];
        sizes[i] += abs(begin.rows[k][i] * lambda[k]);
      }
    }
    V momentum = at.impulse;
    for (std::size_t i = 0; i < momentum.size(); ++i) momentum[i] += p0_[i];
    const V v = velocity_of(momentum);
    const V reach = velocity_of(sizes);
    at.moved = v;
    at.position = q0_;
    for (std::size_t i = 0; i < v.size(); ++i) {
      at.moved[i] = h_ * v[i];
      at.position[i] += at.moved[i];
    }
    at.g = constraints(problem_, at.position);
    at.rows = constraint_gradients(problem_, at.position);
    at.size = at.g;
    for (std::size_t k = 0; k < at.g.size(); ++k) {
      at.size[k] = Real(0);
      for (std::size_t i = 0; i < v.size(); ++i) {
        at.size[k] += abs(at.rows[k][i]) * (abs(at.position[i]) + abs(h_ * reach[i]));
      }
    }
    at.residual = multipliers(begin.rows, begin.with_mass, at.g);
    for (Real& r : at.residual) r = r / h_;
    if (!at.linearised) return;
    at.tangent = Matrix<Real, dynamic>(lambda.size());
    for (std::size_t j = 0; j < lambda.size(); ++j) {
      const Variables column = multipliers(begin.rows, begin.with_mass, products(at.rows, begin.with_mass[j]));
      for (std::size_t k = 0; k < lambda.size(); ++k) at.tangent[k][j] = column[k];
    }
  }
  const Matrix<Real, dynamic>& tangent(const Point& at) const { return at.tangent; }
  Real norm(const Variables&, const Point& at) const {
    Real square(0);
    for (const Real& g : at.g) square += g * g;
    return sqrt(square);
  }
  /// In units of the terms of each constraint, because constraints may have different units.
  Correction<Real> measure(const Variables&, const Point& at, const Variables&) const {
    Real largest(0);
    for (std::size_t k = 0; k < at.g.size(); ++k) {
      const Real part = at.g[k] == Real(0) ? Real(0) : Real(abs(at.g[k]) / at.size[k]);
      largest = part <= largest ? largest : part;  // keeps NaN
    }
    return {largest, std::numeric_limits<Real>::epsilon()};
  }

  Increment<Real, n> taken(Variables&, const Point& at) const { return end_of(at).increment; }
  Increment<Real, n> taken(Variables& lambda, const Point&, const Variables& correction) const {
    for (std::size_t k = 0; k < lambda.size(); ++k) lambda[k] += correction[k];
    Point end = residual_at(lambda);
    settle(lambda, end);
    return taken(lambda, end);
  }
  Memory memory(const Variables& lambda, const Increment<Real, n>&) const { return lambda; }
  Unknowns unknowns(const Variables& lambda, const Increment<Real, n>& taken) const {
    Point at;
    at.linearised = false;
    evaluate(lambda, at);
    const Variables mu = end_of(at).mu;
    Unknowns all(2 * (q0_.size() + lambda.size()));
    std::size_t i = 0;
    for (const Real& x : taken.q) all[i++] = x;
    for (const Real& x : taken.p) all[i++] = x;
    for (const Real& x : lambda) all[i++] = x;
    for (const Real& x : mu) all[i++] = x;
    return all;
  }

  template <class S>
  Vector<S, dynamic> residual(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, dynamic>& u) const {
    const std::size_t size = q0.size();
    const std::size_t count = u.size() / 2 - size;
    Vector<S, n> q1 = q0;
    Vector<S, n> p1 = p0;
    for (std::size_t i = 0; i < size; ++i) {
      q1[i] = q0[i] + u[i];
      p1[i] = p0[i] + u[size + i];
    }
    const Gradients<S, n> rows0 = constraint_gradients(problem_, q0);
    const Gradients<S, n> rows1 = constraint_gradients(problem_, q1);
    Vector<S, n> first = zeros_like(q0);
    Vector<S, n> second = zeros_like(q0);
    force(problem_, q0, first);
    force(problem_, q1, second);
    for (std::size_t i = 0; i < size; ++i) {
      first[i] = h_ / 2 * first[i];
      second[i] = h_ / 2 * second[i];
      for (std::size_t k = 0; k < count; ++k) {
        first[i] = first[i] - rows0[k][i] * u[2 * size + k];
        second[i] = second[i] - rows1[k][i] * u[2 * size + count + k];
      }
    }
    Vector<S, n> middle = p0;
    for (std::size_t i = 0; i < size; ++i) middle[i] = p0[i] + first[i];
    Vector<S, n> v = zeros_like(q0);
    velocity(problem_, middle, v);
    Vector<S, dynamic> r = u;
    for (std::size_t i = 0; i < size; ++i) {
      r[i] = h_ * v[i] - u[i];
      r[size + i] = first[i] + second[i] - u[size + i];
    }
    velocity(problem_, p1, v);
    const Vector<S, dynamic> position = constraints(problem_, q1);
    const Vector<S, dynamic> tangential = products(rows1, v);
    for (std::size_t k = 0; k < count; ++k) {
      r[2 * size + k] = position[k];
      r[2 * size + count + k] = tangential[k];
    }
    return r;
  }

 private:
  /// Values at the start of a step, computed on first use, because equations that are differentiated have no start.
  struct Begin {
    V kick{};    // -h/2 V'(q0)
    V kicked{};  // p0 plus the kick
    Rows rows{};
    Rows with_mass{};
  };
  const Begin& begin() const {
    if (!begin_) {
      begin_.emplace();
      begin_->kick = kick_at(q0_);
      begin_->kicked = p0_;
      for (std::size_t i = 0; i < q0_.size(); ++i) begin_->kicked[i] += begin_->kick[i];
      begin_->rows = constraint_gradients(problem_, q0_);
      begin_->with_mass = with_mass(begin_->rows);
    }
    return *begin_;
  }
  struct End {
    Increment<Real, n> increment{};
    Variables mu{};
  };
  Point residual_at(const Variables& lambda) const {
    Point at;
    at.linearised = false;
    evaluate(lambda, at);
    return at;
  }
  /// Reduces g at the end of the step to its rounding. Newton predicts the next correction from the largest residual of
  /// all constraints, which is too small if one constraint is nearly linear and another is not. In nearly all steps g
  /// is at its rounding already and nothing changes.
  void settle(Variables& lambda, Point& end) const {
    constexpr int most = 3;
    for (int more = 0; more < most; ++more) {
      const Real left = measure(lambda, end, lambda).size;
      if (!(left > Real(64) * std::numeric_limits<Real>::epsilon())) return;
      Point at;
      evaluate(lambda, at);
      LuFactors<Real> factors;
      factors.factor(at.tangent);
      const Variables correction = factors.solve(at.residual);
      ++effort_.linear_solves;
      Variables nearer = lambda;
      for (std::size_t k = 0; k < lambda.size(); ++k) nearer[k] += correction[k];
      Point there = residual_at(nearer);
      if (!(measure(nearer, there, nearer).size < left)) return;
      lambda = nearer;
      end = std::move(there);
    }
  }
  End end_of(const Point& at) const {
    V change = kick_at(at.position);
    V momentum = at.impulse;
    for (std::size_t i = 0; i < change.size(); ++i) momentum[i] += change[i] + p0_[i];
    End end;
    end.mu = multipliers(at.rows, with_mass(at.rows), products(at.rows, velocity_of(momentum)));
    for (std::size_t k = 0; k < end.mu.size(); ++k) {
      for (std::size_t i = 0; i < change.size(); ++i) change[i] -= at.rows[k][i] * end.mu[k];
    }
    end.increment = {at.moved, at.impulse};
    for (std::size_t i = 0; i < change.size(); ++i) end.increment.p[i] += change[i];
    return end;
  }
  V kick_at(const V& q) const {
    V f = zeros_like(q);
    force(problem_, q, f);
    ++effort_.force;
    for (Real& x : f) x = h_ / 2 * x;
    return f;
  }
  V velocity_of(const V& p) const {
    V v = zeros_like(p);
    velocity(problem_, p, v);
    return v;
  }
  Rows with_mass(const Rows& rows) const {
    Rows all;
    for (const V& row : rows) all.push_back(inverse_mass_times(problem_, row));
    return all;
  }

  const P& problem_;
  Real h_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
  mutable std::optional<Begin> begin_{};
};

}  // namespace hamflow
