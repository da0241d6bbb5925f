#include "hamflow/run/fast_functions.hpp"

#include "hamflow/run/forwarding_functions.hpp"

namespace hamflow {

namespace {

template <class S>
using Forwarding = ForwardingFunctions<S>;

/// While it lives, quotients are estimated in the recording of these numbers.
class Estimates {
 public:
  explicit Estimates(const Vector<Trace<double>, dynamic>& x) {
    for (const Trace<double>& number : x) {
      if (!number.is_constant()) recorder_ = number.recorder;
    }
    if (recorder_ != nullptr) recorder_->set_estimates(true);
  }
  ~Estimates() {
    if (recorder_ != nullptr) recorder_->set_estimates(false);
  }
  Estimates(const Estimates&) = delete;
  Estimates& operator=(const Estimates&) = delete;

 private:
  Recorder<double>* recorder_ = nullptr;
};

class FastTraced final : public Forwarding<Trace<double>> {
 public:
  using ForwardingFunctions::ForwardingFunctions;
  void velocity(const V& p, V& v) const override {
    const Estimates on(p);
    exact_->velocity(p, v);
  }
  void force(const V& q, V& f) const override {
    const Estimates on(q);
    exact_->force(q, f);
  }
  void scaled_velocity(const Trace<double>& factor, const V& p, V& v) const override {
    const Estimates on(p);
    exact_->scaled_velocity(factor, p, v);
  }
  void scaled_force(const Trace<double>& factor, const V& q, V& f) const override {
    const Estimates on(q);
    exact_->scaled_force(factor, q, f);
  }
  void gradient(const V& q, const V& p, V& dq, V& dp) const override {
    const Estimates by_q(q), by_p(p);
    exact_->gradient(q, p, dq, dp);
  }
  void force_and_hessian(const V& q, V& f, M& h) const override {
    const Estimates on(q);
    exact_->force_and_hessian(q, f, h);
  }
};

Vector<Trace<double>, dynamic> inputs(Recorder<double>& recorder, const Vector<double, dynamic>& x) {
  auto all = zeros<Trace<double>, dynamic>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) all[i] = recorder.input(x[i]);
  return all;
}

/// One for each thread, so that its memory serves every call.
Recorder<double>& fresh_recorder() {
  thread_local Recorder<double> recorder(Folding::exact);
  recorder.clear();
  return recorder;
}

/// In double: each call is a recording of its own, of which the values are taken. Slow, and rare.
class FastPlain final : public Forwarding<double> {
 public:
  FastPlain(Pointer exact, std::shared_ptr<const Functions<Trace<double>>> traced)
      : ForwardingFunctions(std::move(exact)), traced_(std::move(traced)) {}

  void velocity(const V& p, V& v) const override {
    Recorder<double>& recorder = fresh_recorder();
    auto out = zeros<Trace<double>, dynamic>(p.size());
    traced_->velocity(inputs(recorder, p), out);
    put(out, v);
  }
  void force(const V& q, V& f) const override {
    Recorder<double>& recorder = fresh_recorder();
    auto out = zeros<Trace<double>, dynamic>(q.size());
    traced_->force(inputs(recorder, q), out);
    put(out, f);
  }
  void scaled_velocity(const double& factor, const V& p, V& v) const override {
    Recorder<double>& recorder = fresh_recorder();
    auto out = zeros<Trace<double>, dynamic>(p.size());
    traced_->scaled_velocity(factor, inputs(recorder, p), out);
    put(out, v);
  }
  void scaled_force(const double& factor, const V& q, V& f) const override {
    Recorder<double>& recorder = fresh_recorder();
    auto out = zeros<Trace<double>, dynamic>(q.size());
    traced_->scaled_force(factor, inputs(recorder, q), out);
    put(out, f);
  }
  void gradient(const V& q, const V& p, V& dq, V& dp) const override {
    Recorder<double>& recorder = fresh_recorder();
    auto by_q = zeros<Trace<double>, dynamic>(q.size()), by_p = by_q;
    const auto x = inputs(recorder, q);
    traced_->gradient(x, inputs(recorder, p), by_q, by_p);
    put(by_q, dq);
    put(by_p, dp);
  }
  void force_and_hessian(const V& q, V& f, M& h) const override {
    Recorder<double>& recorder = fresh_recorder();
    const auto x = inputs(recorder, q);
    auto out = zeros<Trace<double>, dynamic>(q.size());
    auto second = zero_matrix(x);
    traced_->force_and_hessian(x, out, second);
    put(out, f);
    for (std::size_t i = 0; i < q.size(); ++i) {
      for (std::size_t j = 0; j < q.size(); ++j) h[i][j] = second[i][j].value;
    }
  }

 private:
  static void put(const Vector<Trace<double>, dynamic>& from, V& to) {
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = from[i].value;
  }

  std::shared_ptr<const Functions<Trace<double>>> traced_;
};

/// More than the operations of any gradient in which the first estimate comes late.
constexpr std::size_t first_operations = 20000;

}  // namespace

FastFunctions fast_functions(std::shared_ptr<const Functions<double>> plain,
                             std::shared_ptr<const Functions<Trace<double>>> trace) {
  auto traced = std::make_shared<const FastTraced>(std::move(trace));
  return {std::make_shared<const FastPlain>(std::move(plain), traced), traced};
}

bool has_estimates(const FastFunctions& functions, const Vector<double, dynamic>& q, const Vector<double, dynamic>& p) {
  Recorder<double> recorder(Folding::exact, first_operations);
  try {
    auto by_q = zeros<Trace<double>, dynamic>(q.size()), by_p = by_q;
    const auto x = inputs(recorder, q);
    functions.trace->gradient(x, inputs(recorder, p), by_q, by_p);
  } catch (const CannotRecord&) {  // of many bodies, say: what was seen decides
  }
  return recorder.has_estimated();
}

}  // namespace hamflow
