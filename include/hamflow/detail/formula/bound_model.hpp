// A typed Hamiltonian with values for its parameters, in one number type.
#pragma once

#include <mutex>
#include <optional>

#include "hamflow/core/constraints.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/detail/formula/model.hpp"

namespace hamflow::formula {

/// The functions of a problem for states of any type S. Copies share the model.
template <class R>
class BoundModel {
 public:
  /// @param rounded if not null, constants are computed in double from these values, so that they equal those of a run
  /// in double   @throws Error that names a constant part that is not finite with these values
  BoundModel(std::shared_ptr<const Model> model, const Parameters<R>& values,
             const Parameters<double>* rounded = nullptr)
      : model_(std::move(model)), value_of_(lookup(values)) {
    if (rounded != nullptr) rounded_value_of_ = lookup(*rounded);
    energy_ = bound(model_->energy);
    gradient_ = bound(model_->gradient);
    invariants_ = bound(model_->invariant_values);
    if (model_->structure().separable) {
      kinetic_ = bound(model_->kinetic);
      potential_ = bound(model_->potential);
      velocity_ = bound(model_->velocity);
      force_ = bound(model_->force);
    }
    if (model_->constraints) {
      constraints_ = bound(model_->constraints);
      constraint_gradients_ = bound(model_->constraint_gradients);
      constraint_curvatures_ = bound(model_->constraint_curvatures);
    }
    if (model_->scaled_force) {
      scaled_force_ = bound(model_->scaled_force);
      scaled_velocity_ = bound(model_->scaled_velocity);
    }
  }

  const Model& model() const { return *model_; }
  std::size_t size() const { return model_->degrees(); }

  template <class S>
  using V = Vector<S, dynamic>;
  template <class S>
  using M = Matrix<S, dynamic>;

  template <class S>
  S energy(const V<S>& q, const V<S>& p, const S& t = S(R(0))) const {
    return one(energy_, q, p, t);
  }
  template <class S>
  S kinetic(const V<S>& p) const {
    return one(kinetic_, p, p, S(R(0)));
  }
  template <class S>
  S potential(const V<S>& q) const {
    return one(potential_, q, q, S(R(0)));
  }
  template <class S>
  void velocity(const V<S>& p, V<S>& v) const {
    run(velocity_, p, p, S(R(0)), [&](std::size_t i, const S& x) { v[i] = x; });
  }
  template <class S>
  void force(const V<S>& q, V<S>& f) const {
    run(force_, q, q, S(R(0)), [&](std::size_t i, const S& x) { f[i] = x; });
  }
  bool has_scaled() const { return model_->scaled_force != nullptr; }
  template <class S>
  void scaled_velocity(const S& factor, const V<S>& p, V<S>& v) const {
    run(
        scaled_velocity_, p, p, S(R(0)), [&](std::size_t i, const S& x) { v[i] = x; }, &factor);
  }
  template <class S>
  void scaled_force(const S& factor, const V<S>& q, V<S>& f) const {
    run(
        scaled_force_, q, q, S(R(0)), [&](std::size_t i, const S& x) { f[i] = x; }, &factor);
  }
  template <class S>
  void gradient(const V<S>& q, const V<S>& p, V<S>& dq, V<S>& dp) const {
    run(gradient_, q, p, S(R(0)), [&](std::size_t i, const S& x) { (i < size() ? dq[i] : dp[i - size()]) = x; });
  }
  template <class S>
  void hessian(const V<S>& q, const V<S>& p, M<S>& qq, M<S>& qp, M<S>& pp) const {
    const Second& second = second_derivatives();
    const HessianCode& code = *second.hessian_entries;
    for (M<S>* m : {&qq, &qp, &pp}) clear(*m);
    run(second.hessian, q, p, S(R(0)), [&](std::size_t k, const S& x) {
      if (k < code.qq.size()) {
        put_symmetric(qq, code.qq[k], x);
      } else if (k -= code.qq.size(); k < code.qp.size()) {
        qp[code.qp[k].first][code.qp[k].second] = x;
      } else {
        put_symmetric(pp, code.pp[k - code.qp.size()], x);
      }
    });
  }
  template <class S>
  void force_and_hessian(const V<S>& q, V<S>& f, M<S>& hessian) const {
    const Second& second = second_derivatives();
    const ForceAndHessianCode& code = *second.force_and_hessian_entries;
    clear(hessian);
    run(second.force_and_hessian, q, q, S(R(0)), [&](std::size_t k, const S& x) {
      if (k < size()) {
        f[k] = x;
      } else {
        put_symmetric(hessian, code.entries[k - size()], x);
      }
    });
  }
  template <class S>
  V<S> invariants(const V<S>& q, const V<S>& p, const S& t) const {
    V<S> all = zeros<S, dynamic>(model_->invariants().size());
    run(invariants_, q, p, t, [&](std::size_t i, const S& x) { all[i] = x; });
    return all;
  }

  template <class S>
  V<S> constraints(const V<S>& q) const {
    V<S> all = zeros<S, dynamic>(model_->structure().constraints);
    run(constraints_, q, q, S(R(0)), [&](std::size_t k, const S& x) { all[k] = x; });
    return all;
  }
  template <class S>
  Gradients<S, dynamic> constraint_gradients(const V<S>& q) const {
    Gradients<S, dynamic> all(model_->structure().constraints, zeros_like(q));
    run(constraint_gradients_, q, q, S(R(0)), [&](std::size_t k, const S& x) { all[k / size()][k % size()] = x; });
    return all;
  }
  /// g''(v, v).
  template <class S>
  V<S> constraint_curvatures(const V<S>& q, const V<S>& v) const {
    V<S> all = zeros<S, dynamic>(model_->structure().constraints);
    run(constraint_curvatures_, q, v, S(R(0)), [&](std::size_t k, const S& x) { all[k] = x; });
    return all;
  }

 private:
  template <class S>
  std::function<S(int)> lookup(const Parameters<S>& values) const {
    return [values, m = model_](int symbol) {
      const Model::ParameterPlace& place = m->parameter(symbol);
      return values.list(place.name).at(place.index);
    };
  }
  BoundCode<R> bound(const std::shared_ptr<const Code>& code) const {
    if (!rounded_value_of_) return BoundCode<R>(code, value_of_);
    std::vector<R> constants;
    for (const double c : constants_of<double>(*code, rounded_value_of_)) constants.push_back(R(c));
    return BoundCode<R>(code, std::move(constants));
  }

  template <class S, class Put>
  void run(const BoundCode<R>& code, const V<S>& q, const V<S>& p, const S& t, const Put& put,
           const S* factor = nullptr) const {
    const std::size_t n = model_->size();
    const bool timed = model_->structure().time;
    std::optional<S> now;
    code.template run<S>(
        [&](int symbol) -> const S& {
          const auto i = static_cast<std::size_t>(symbol);
          if (i < n) return q[i];
          if (i < 2 * n) return p[i - n];
          if (i == 2 * n && timed && !now) now.emplace(q[n + 1] + q[n]);
          if (i == 2 * n) return timed ? *now : t;
          return i == model_->factor_symbol() ? *factor : p[n];
        },
        put);
  }
  template <class S>
  S one(const BoundCode<R>& code, const V<S>& q, const V<S>& p, const S& t) const {
    S result{};
    run(code, q, p, t, [&](std::size_t, const S& x) { result = x; });
    return result;
  }
  template <class S>
  static void clear(M<S>& m) {
    for (std::size_t i = 0; i < m.size(); ++i) {
      for (std::size_t j = 0; j < m.size(); ++j) m[i][j] = S(R(0));
    }
  }
  template <class S>
  static void put_symmetric(M<S>& m, const std::pair<std::size_t, std::size_t>& at, const S& x) {
    m[at.first][at.second] = x;
    m[at.second][at.first] = x;
  }

  /// Second derivatives. They are bound when a method first needs them.
  struct Second {
    std::once_flag once;
    const HessianCode* hessian_entries = nullptr;
    const ForceAndHessianCode* force_and_hessian_entries = nullptr;
    BoundCode<R> hessian;
    BoundCode<R> force_and_hessian;
  };
  const Second& second_derivatives() const {
    std::call_once(second_->once, [this] {
      second_->hessian_entries = &model_->hessian();
      second_->hessian = bound(second_->hessian_entries->code);
      if (!model_->structure().separable) return;
      second_->force_and_hessian_entries = &model_->force_and_hessian();
      second_->force_and_hessian = bound(second_->force_and_hessian_entries->code);
    });
    return *second_;
  }

  std::shared_ptr<const Model> model_;
  std::function<R(int)> value_of_;
  std::function<double(int)> rounded_value_of_;
  BoundCode<R> energy_, kinetic_, potential_, velocity_, force_, gradient_, invariants_;
  BoundCode<R> scaled_force_, scaled_velocity_;
  BoundCode<R> constraints_, constraint_gradients_, constraint_curvatures_;
  std::shared_ptr<Second> second_ = std::make_shared<Second>();
};

}  // namespace hamflow::formula
