// The Hamiltonian whose potential a client computes: H = sum |p_i|^2/(2 m_i) + V(q).
#pragma once

#include <memory>
#include <vector>

#include "force_server.hpp"
#include "hamflow/core/vector.hpp"

namespace hamflow {

/// V and its forces from a client, in the units of a scenario. It remembers the last two positions, so that forces and
/// energy of one state are evaluated once.
class ClientForces {
 public:
  /// @param length_unit in bohr   @param energy_unit in hartree
  ClientForces(std::shared_ptr<ForceServer> server, const Cell& cell, double length_unit, double energy_unit,
               double timeout)
      : server_(std::move(server)), cell_(cell), length_(length_unit), energy_(energy_unit), timeout_(timeout) {}

  double potential(const Vector<double, dynamic>& q);
  void force(const Vector<double, dynamic>& q, Vector<double, dynamic>& f);
  /// Remembers the evaluation that was used last until the next call of keep(): the energy of the state before a step
  /// is still known if the step fails.
  void keep();

 private:
  struct Evaluation {
    std::vector<double> q;
    double potential = 0;
    std::vector<double> force;
  };
  const Evaluation& at(const Vector<double, dynamic>& q);

  std::shared_ptr<ForceServer> server_;
  Cell cell_;
  double length_, energy_, timeout_;
  std::mutex mutex_;  // copies of a simulation may run in several threads
  Evaluation last_, kept_;
  bool kept_is_used_ = false;  // by the last call
  std::vector<double> positions_;
  WireForces wire_;
};

class SocketProblem {
 public:
  using Real = double;
  using V = Vector<double, dynamic>;
  static constexpr std::size_t dimension = dynamic;
  static constexpr bool quadratic_kinetic = true;
  static ProblemInfo info() { return {.name = SocketKeys::problem}; }

  /// @param masses one for all atoms, or one for each
  SocketProblem(std::vector<double> masses, std::size_t size, std::shared_ptr<ClientForces> client)
      : masses_(std::move(masses)), size_(size), client_(std::move(client)) {}

  std::size_t size() const { return size_; }
  double kinetic(const V& p) const;
  double potential(const V& q) const { return client_->potential(q); }
  void velocity(const V& p, V& v) const;
  void force(const V& q, V& f) const { client_->force(q, f); }
  double mass(std::size_t coordinate) const { return masses_.size() == 1 ? masses_[0] : masses_[coordinate / 3]; }

 private:
  std::vector<double> masses_;
  std::size_t size_;
  std::shared_ptr<ClientForces> client_;
};

}  // namespace hamflow
