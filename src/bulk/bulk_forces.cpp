#include "hamflow/core/bulk_forces.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>

#include "hamflow/core/error.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/detail/core/thread_team.hpp"
#include "neighbours.hpp"

namespace hamflow {

namespace {
using Cutoff = BulkPairSystem::Cutoff;
using Kind = BulkPairSystem::Law;

void require(bool holds, const char* name, double found, const std::string& allowed) {
  if (!holds) throw Error(std::string(name) + ": found " + shortest(found) + "; allowed " + allowed);
}

void check(const BulkPairSystem& s) {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  require(s.space == 2 || s.space == 3, "space", static_cast<double>(s.space), "2, 3");
  require(s.particles >= 1 && s.particles < (std::size_t{1} << 31), "particles", static_cast<double>(s.particles),
          "1 to 2^31 - 1");
  require(positive(s.length_scale), "length_scale", s.length_scale, "a number above 0");
  require(positive(s.sigma), "sigma", s.sigma, "a number above 0");
  require(s.strengths.empty() || s.strengths.size() == s.particles, "strengths",
          static_cast<double>(s.strengths.size()), "one for each particle, or none");
  require(s.strengths.empty() || s.law == Kind::newton, "strengths", static_cast<double>(s.strengths.size()),
          "none with lennard_jones");
  if (s.cutoff == Cutoff::none) {
    for (const double edge : s.edges) require(edge == 0, "edges", edge, "0 without a cut-off");
    return;
  }
  require(positive(s.radius), "radius", s.radius, "a number above 0");
  require(s.skin >= 0 && std::isfinite(s.skin), "skin", s.skin, "a number from 0");
  if (s.cutoff == Cutoff::smooth) {
    require(s.inner >= 0 && s.inner < s.radius, "inner", s.inner, "a number from 0 and below the radius");
  }
  for (std::size_t k = 0; k < s.space; ++k) {
    const double edge = s.edges[k];
    require(edge == 0 || (positive(edge) && s.radius / s.length_scale <= edge / 2), "edges", edge,
            "0, or at least twice the radius");
  }
}

BulkSet chosen(BulkSet set) {
  if (set != BulkSet::best) return set;
  if (BulkForces::has(BulkSet::avx512)) return BulkSet::avx512;
  return BulkForces::has(BulkSet::avx2) ? BulkSet::avx2 : BulkSet::sse2;
}

const bulk::Kernels& kernels_of(BulkSet set) {
  if (!BulkForces::has(set)) throw Error("bulk forces: this machine does not have the requested instruction set");
  if (set == BulkSet::avx512) return bulk::avx512;
  return set == BulkSet::avx2 ? bulk::avx2 : bulk::sse2;
}

/// The law in the units of the coordinates, and the factors for the sums of a row.
struct Scaled {
  bulk::Law law{};
  double of_force;   // the factor of c d
  double of_energy;  // the factor of phi
};
Scaled scaled(const BulkPairSystem& s) {
  Scaled r{};
  bulk::Law& law = r.law;
  const double sigma = s.sigma / s.length_scale;
  const double softening = s.softening / s.length_scale;
  const double cut = s.radius / s.length_scale;
  const double inner = s.inner / s.length_scale;
  law.sigma_squared = sigma * sigma;
  law.attraction = s.attraction;
  law.half_attraction = s.attraction / 2;
  law.softening_squared = softening * softening;
  law.cut_squared = cut * cut;
  double phi = 0;  // phi and its derivative at the cut-off
  double slope = 0;
  if (s.law == Kind::lennard_jones) {
    // F = -grad phi = 12/sigma^2 s^4 (s^3 - a/2) d.
    r.of_force = s.prefactor * s.factor * 12 / law.sigma_squared;
    r.of_energy = s.prefactor * s.factor;
    const double at = law.sigma_squared / law.cut_squared;
    const double cube = at * at * at;
    phi = cube * (cube - s.attraction);
    slope = -12 * cube * (cube - s.attraction / 2) / cut;
  } else {
    // -1/sqrt((S r)^2 + softening^2) = -(1/S)/sqrt(r^2 + (softening/S)^2).
    r.of_force = r.of_energy = s.prefactor * s.factor / s.length_scale;
    const double root = std::sqrt(law.cut_squared + law.softening_squared);
    phi = -1 / root;
    slope = cut / (root * root * root);
  }
  const double unit = r.of_force / r.of_energy;  // F/(of_energy d) = c unit
  law.shift = phi;
  if (s.cutoff == Cutoff::force_shifted) {
    law.slope = slope;
    law.slope_in_c = slope / unit;
    law.shift = phi - cut * slope;
  }
  law.inner_squared = inner * inner;
  law.inverse_width = 1 / (law.cut_squared - law.inner_squared);
  law.turn_in_c = 2 * 630 * law.inverse_width / unit;  // -2 phi s'(x) dx/du
  return r;
}
}  // namespace

const bulk::Kernels& bulk::widest() { return kernels_of(chosen(BulkSet::best)); }

class BulkForces::Workspace {
 public:
  Workspace(const BulkPairSystem& system, BulkSet set)
      : system_(system), set_(chosen(set)), kernels_(&kernels_of(set_)), scaled_(scaled(system)) {
    rows_.law = scaled_.law;
    rows_.particles = system.particles;
    rows_.force_factor = scaled_.of_force;
    rows_.times_strength = !system.strengths.empty();
    for (std::size_t k = 0; k < system.space; ++k) {
      rows_.edge[k] = system.edges[k];
      rows_.inverse_edge[k] = system.edges[k] == 0 ? 0 : 1 / system.edges[k];
    }
    const std::size_t room = (system.particles + 15) / 16 * 16;
    energy_.resize(room);
    rows_.energy = energy_.data();
    known_at_.resize(system.space * system.particles);
    unused_.resize(known_at_.size());
    if (lists()) {
      prepare_lists();
    } else {
      for (std::size_t k = 0; k < system.space; ++k) {
        x_[k].resize(room);
        rows_.x[k] = x_[k].data();
      }
      w_.resize(room);
      for (std::size_t i = 0; i < system.particles; ++i) w_[i] = system.strengths.empty() ? 1 : system.strengths[i];
      rows_.w = w_.data();
      x_room_ = room;
      divide_rows();
    }
  }

  void use_threads(std::size_t count) {
    const std::lock_guard turn(busy_);
    if (count == (team_ ? team_->size() : 1)) return;
    team_.reset();
    if (count > 1) team_.emplace(count);
    if (lists()) prepare_lists();
  }

  /// Computes forces. If the potential is regularly requested at the positions of every n-th force, it is computed
  /// together with that force, so that monitoring the energy needs no second pass.
  void force(const double* q, double* f) {
    const std::lock_guard turn(busy_);
    ++forces_since_potential_;
    const bool expected = forces_since_potential_ == usual_forces_;
    pass(q, f, expected);
    if (!expected) std::memcpy(known_at_.data(), q, bytes());
  }
  double force_and_potential(const double* q, double* f) {
    const std::lock_guard turn(busy_);
    return pass(q, f, true);
  }
  double potential(const double* q) {
    const std::lock_guard turn(busy_);
    const bool at_last_force = std::memcmp(q, known_at_.data(), bytes()) == 0;
    if (forces_since_potential_ > 0) usual_forces_ = at_last_force ? forces_since_potential_ : 0;
    forces_since_potential_ = 0;
    if (knows_ && at_last_force) return known_;
    return pass(q, unused_.data(), true);
  }
  Counts counts() {
    const std::lock_guard turn(busy_);
    return counts_;
  }
  BulkSet set() const { return set_; }

 private:
  bool lists() const { return system_.cutoff != Cutoff::none; }
  std::size_t bytes() const { return system_.space * system_.particles * sizeof(double); }
  std::size_t workers() const { return team_ ? team_->size() : 1; }

  void prepare_lists() {
    const double s = system_.length_scale;
    neighbours_.prepare({system_.space, system_.edges, system_.radius / s, system_.skin / s}, system_.particles,
                        workers());
    memory_.clear();
    scratch_.assign(workers(), {});
  }
  void make_room() {
    const std::size_t row = (neighbours_.longest_row() + 31) / 8 * 8;
    if (!memory_.empty() && scratch_[0].row >= row) return;
    const std::size_t roomy = (row + row / 4) / 8 * 8;
    memory_.resize(workers());
    for (std::size_t w = 0; w < workers(); ++w) {
      memory_[w].resize(8 * roomy);
      scratch_[w] = {memory_[w].data(), roomy};
    }
  }

  double pass(const double* q, double* f, bool with_energy) {
    ++counts_.evaluations;
    knows_ = false;
    if (!(size_of(q) <= std::numeric_limits<double>::max())) return nothing(q, f);
    rows_.force = f;
    if (lists()) {
      sum_lists(q, with_energy);
    } else {
      sum_all(q, with_energy);
    }
    if (!with_energy) return 0;
    known_ = total();
    std::memcpy(known_at_.data(), q, bytes());
    knows_ = true;
    return known_;
  }
  /// Returns the sum of |q|, from independent partial sums.
  double size_of(const double* q) const {
    double sums[8] = {};
    const std::size_t size = system_.space * system_.particles;
    std::size_t i = 0;
    for (; i + 8 <= size; i += 8) {
      for (std::size_t k = 0; k < 8; ++k) sums[k] += std::abs(q[i + k]);
    }
    for (; i < size; ++i) sums[0] += std::abs(q[i]);
    return ((sums[0] + sums[1]) + (sums[2] + sums[3])) + ((sums[4] + sums[5]) + (sums[6] + sums[7]));
  }
  /// Sets forces to NaN, for positions that are not finite and belong to no cell.
  double nothing(const double*, double* f) const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::fill(f, f + system_.space * system_.particles, none);
    return none;
  }

  void sum_lists(const double* q, bool with_energy) {
    ThreadTeam* const team = team_ ? &*team_ : nullptr;
    if (system_.rebuild_every_time || !neighbours_.place(q, team)) {
      neighbours_.make(q, kernels_->near[system_.space - 2], team);
      neighbours_.set_strengths(system_.strengths);
      neighbours_.show(rows_);
      make_room();
      ++counts_.lists;
    }
    const auto law = static_cast<std::size_t>(system_.law);
    const auto cut = static_cast<std::size_t>(system_.cutoff) - 1;
    const bulk::SumRows sum = kernels_->listed[law][cut][system_.space - 2][with_energy];
    const auto blocks = neighbours_.blocks();
    run(blocks.size(), [&](std::size_t worker, std::size_t b) {
      const auto& block = blocks[b];
      return sum(rows_, block.first, block.last, block.candidates(), scratch_[worker]);
    });
  }

  void sum_all(const double* q, bool with_energy) {
    const std::size_t space = system_.space;
    for (std::size_t i = 0; i < system_.particles; ++i) {
      for (std::size_t k = 0; k < space; ++k) x_[k][i] = q[i * space + k];
    }
    const bulk::SumRows sum = kernels_->all[static_cast<std::size_t>(system_.law)][space - 2][with_energy];
    std::fill(total_.data(), total_.data() + space * x_room_, 0.0);
    const auto sum_block = [&](std::size_t b, double* forces) {
      const std::size_t from = row_blocks_[b] / 16 * 16;  // a block adds nothing to earlier rows
      for (std::size_t k = 0; k < space; ++k) std::fill(forces + k * x_room_ + from, forces + (k + 1) * x_room_, 0.0);
      return sum(rows_, row_blocks_[b], row_blocks_[b + 1], {}, {forces, x_room_});
    };
    const auto add_block = [&](std::size_t b, const double* forces) {
      for (std::size_t k = 0; k < space; ++k) {
        double* const total = total_.data() + k * x_room_;
        for (std::size_t i = row_blocks_[b]; i < system_.particles; ++i) total[i] += forces[k * x_room_ + i];
      }
    };
    // The forces of blocks are added in their order. One thread does so while they are in its cache.
    const std::size_t blocks = row_blocks_.size() - 1;
    const std::size_t size = space * x_room_;
    if (team_) {
      run(blocks, [&](std::size_t, std::size_t b) { return sum_block(b, block_forces_.data() + b * size); });
      for (std::size_t b = 0; b < blocks; ++b) add_block(b, block_forces_.data() + b * size);
    } else {
      for (std::size_t b = 0; b < blocks; ++b) {
        sum_block(b, block_forces_.data());
        add_block(b, block_forces_.data());
      }
    }
    for (std::size_t i = 0; i < system_.particles; ++i) {
      for (std::size_t k = 0; k < space; ++k) {
        rows_.force[i * space + k] = total_[k * x_room_ + i] * scaled_.of_force;
      }
    }
    counts_.pairs += system_.particles * (system_.particles - 1) / 2;
  }
  /// Divides rows into blocks with about equal numbers of pairs, independently of the number of threads, because the
  /// forces of each block are summed separately.
  void divide_rows() {
    constexpr std::size_t blocks = 16;
    const std::size_t n = system_.particles;
    const std::size_t each = n * (n - 1) / 2 / blocks + 1;
    row_blocks_.assign(1, 0);
    std::size_t held = 0;
    for (std::size_t i = 0; i < n; ++i) {
      held += n - 1 - i;
      if (held < each && i + 1 < n) continue;
      row_blocks_.push_back(i + 1);
      held = 0;
    }
    block_forces_.resize((row_blocks_.size() - 1) * system_.space * x_room_);
    total_.resize(system_.space * x_room_);
  }

  template <class Work>
  void run(std::size_t blocks, const Work& work) {
    std::uint64_t pairs = 0;
    if (!team_ || blocks < 2) {
      for (std::size_t b = 0; b < blocks; ++b) pairs += work(std::size_t{0}, b);
    } else {
      std::atomic<std::uint64_t> found{0};
      auto job = [&](std::size_t worker, std::uint64_t, std::size_t b) {
        found.fetch_add(work(worker, b), std::memory_order_relaxed);
      };
      team_->share(blocks, job);
      pairs = found.load();
    }
    counts_.pairs += pairs / 2;
  }

  /// Sums the energies of rows in eight partial sums. With lists each pair is in two rows.
  double total() const {
    double sums[8] = {};
    for (std::size_t i = 0; i < system_.particles; ++i) sums[i % 8] += energy_[i];
    const double all = ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
    return all * (lists() ? scaled_.of_energy / 2 : scaled_.of_energy);
  }

  std::mutex busy_;
  BulkPairSystem system_;
  BulkSet set_;
  const bulk::Kernels* kernels_;
  Scaled scaled_;
  bulk::Rows rows_;
  bulk::Neighbours neighbours_;
  bulk::Numbers x_[3];
  bulk::Numbers w_;
  std::size_t x_room_ = 0;
  std::vector<std::size_t> row_blocks_;
  bulk::Numbers block_forces_;
  bulk::Numbers total_;
  bulk::Numbers energy_;
  std::vector<bulk::Numbers> memory_;
  std::vector<bulk::Scratch> scratch_;
  std::optional<ThreadTeam> team_;
  std::vector<double> unused_;
  std::vector<double> known_at_;
  double known_ = 0;
  bool knows_ = false;  // whether the potential at known_at_ is known; else known_at_ is the place of the last force
  std::uint64_t forces_since_potential_ = 0;
  std::uint64_t usual_forces_ = 0;  // number of forces before the potential is requested
  Counts counts_;
};

BulkForces::BulkForces(const BulkPairSystem& system, BulkSet set) {
  check(system);
  workspace_ = std::make_shared<Workspace>(system, set);
}
void BulkForces::force(const double* q, double* f) const { workspace_->force(q, f); }
double BulkForces::force_and_potential(const double* q, double* f) const {
  return workspace_->force_and_potential(q, f);
}
double BulkForces::potential(const double* q) const { return workspace_->potential(q); }
void BulkForces::use_threads(std::size_t count) const { workspace_->use_threads(count); }
BulkForces::Counts BulkForces::counts() const { return workspace_->counts(); }
BulkSet BulkForces::set() const { return workspace_->set(); }

}  // namespace hamflow
