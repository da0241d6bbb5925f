// A simulation by name in double whose steps are solved by iteration, and which can hand them over to lanes
// (recorded_iteration.hpp). By itself it is the one behind virtual calls.
#pragma once

#include <memory>
#include <utility>

#include "hamflow/run/in_parts.hpp"
#include "hamflow/run/recorded_iteration.hpp"

namespace hamflow {

template <class P, class M, Arithmetic A>
class IteratedSimulation final : public InParts<SimulationOf<P, M, A>>, public IteratedMember {
  using Base = InParts<SimulationOf<P, M, A>>;
  using Base::clock_;
  using Base::method_;
  using Base::probe_;
  using Base::z_;
  using Equations = typename M::Equations;

 public:
  IteratedSimulation(SimulationOf<P, M, A> simulation, IterationRecorder recorder)
      : Base(std::move(simulation)), recorder_(std::make_shared<const IterationRecorder>(std::move(recorder))) {
    frame_.n = z_.q.size();
    frame_.m = Equations(method_.setup(), Base::problem(), clock_.step(), z_.positions(), z_.momenta(), unused())
                   .last_state()
                   .size();
    for_each_carried([&](double&) { ++frame_.recorded; }, z_, probe_);
  }

  const IterationFrame& frame() const override { return frame_; }
  NewtonOptions newton() const override { return method_.setup().newton(); }
  bool automatic() const override { return method_.setup().automatic(); }
  int points() const override { return method_.setup().mark(); }
  bool can_be_recorded() const override { return static_cast<bool>(*recorder_); }
  std::optional<RecordedIteration> recorded_iteration() const override {
    std::vector<double> values(frame_.size());
    if (!read(values)) return std::nullopt;
    return (*recorder_)(frame_, values, points(), clock_.start());
  }

  bool read(std::span<double> values) const override {
    values[IterationFrame::h] = clock_.step_length();
    values[IterationFrame::position] = static_cast<double>(clock_.position());
    auto z = z_;
    auto probe = probe_;
    std::size_t k = IterationFrame::carried;
    for_each_carried([&](double& x) { values[k++] = x; }, z, probe);
    if (!method_.newton().trusts_memory()) return false;
    const Vector<double, dynamic> q0 = z_.positions();
    const Vector<double, dynamic> p0 = z_.momenta();
    const auto& last = method_.newton().memory().predicted();
    const auto x = Equations(method_.setup(), Base::problem(), clock_.step_length(), q0, p0, unused()).started(last);
    if (last.size() != frame_.m) return false;
    for (std::size_t i = 0; i < frame_.m; ++i) {
      values[frame_.memory() + i] = last[i];
      values[frame_.x() + i] = x[i];
    }
    return true;
  }
  void take(std::span<const double> values, std::int64_t steps, const Effort& effort) override {
    std::size_t k = IterationFrame::carried;
    for_each_carried([&](double& x) { x = values[k++]; }, z_, probe_);
    Vector<double, dynamic> last(frame_.m);
    for (std::size_t i = 0; i < frame_.m; ++i) last[i] = values[frame_.memory() + i];
    method_.go_on(last, effort);
    clock_.advance(steps);
  }
  double time_after(std::int64_t steps) const override { return static_cast<double>(clock_.time_after(steps)); }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override {
    return std::make_unique<IteratedSimulation>(*this);
  }

 private:
  static Effort& unused() {
    static thread_local Effort effort;
    return effort;
  }

  IterationFrame frame_;
  std::shared_ptr<const IterationRecorder> recorder_;
};

}  // namespace hamflow
