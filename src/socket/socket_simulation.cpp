#include "socket_simulation.hpp"

#include <utility>

namespace hamflow {

namespace {

class SocketSimulation final : public Simulation {
 public:
  SocketSimulation(std::unique_ptr<Simulation> inner, std::shared_ptr<ClientForces> client)
      : inner_(std::move(inner)), client_(std::move(client)) {
    client_->keep();
  }

  /// Takes steps one by one: an exception leaves the state as it was when advance() of the inner simulation began.
  /// @throws ClientError with the state after the last complete step
  Outcome advance(std::int64_t steps) override {
    return unless_stopped([&] {
      for (; steps > 0; --steps) {
        const Outcome outcome = inner_->advance(1);
        if (outcome != Outcome::done) return outcome;
        client_->keep();
      }
      return Outcome::done;
    });
  }
  Outcome look_ahead(const std::string& time, Frame& frame) const override {
    return unless_stopped([&] { return inner_->look_ahead(time, frame); });
  }
  Outcome look_part(double theta, Frame& frame) const override {
    return unless_stopped([&] { return inner_->look_part(theta, frame); });
  }
  std::unique_ptr<Simulation> clone() const override {
    return std::make_unique<SocketSimulation>(inner_->clone(), client_);
  }

  std::int64_t step() const override { return inner_->step(); }
  void look(Frame& frame) const override { inner_->look(frame); }
  void reverse_time() override { inner_->reverse_time(); }
  void negate_momenta() override { inner_->negate_momenta(); }
  std::vector<std::byte> bits() const override { return inner_->bits(); }
  Excursion energy() const override { return inner_->energy(); }
  void restart_energy_range() override { inner_->restart_energy_range(); }
  std::vector<InvariantExcursion> invariants() const override { return inner_->invariants(); }
  Effort effort() const override { return inner_->effort(); }
  StepDiagnostics diagnostics() const override { return inner_->diagnostics(); }
  MethodInfo method() const override { return inner_->method(); }
  std::string failure() const override { return inner_->failure(); }
  std::vector<std::byte> save() const override { return inner_->save(); }
  void restore(std::span<const std::byte> saved) override { inner_->restore(saved); }

 private:
  template <class F>
  static Outcome unless_stopped(const F& work) {
    try {
      return work();
    } catch (const ForceServer::Stopped&) {
      return Outcome::stopped;
    }
  }

  std::unique_ptr<Simulation> inner_;
  std::shared_ptr<ClientForces> client_;
};

}  // namespace

std::unique_ptr<Simulation> keeping_good_states(std::unique_ptr<Simulation> simulation,
                                                std::shared_ptr<ClientForces> client) {
  return std::make_unique<SocketSimulation>(std::move(simulation), std::move(client));
}

}  // namespace hamflow
