// The typed block of an ensemble: a problem whose parameters are packs, a splitting whose coefficients are, and a
// state.
#pragma once

#include <limits>
#include <optional>
#include <type_traits>

#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/numerics/pack.hpp"
#include "hamflow/run/ensemble.hpp"
#include "hamflow/run/probe.hpp"

namespace hamflow {

// One function for each instruction set, into which everything is inlined: four registers to a pack, see pack.hpp.
struct GenericLanes {
  using Number = Pack<2, 4>;
  template <class Block>
  [[gnu::noinline, gnu::flatten]] static void march(Block& block, std::int64_t steps) {
    block.march(steps);
  }
};
#if defined(__x86_64__) && defined(__GNUC__)
struct Avx2Lanes {
  using Number = Pack<4, 4>;
  template <class Block>
  __attribute__((target("avx2"), noinline, flatten)) static void march(Block& block, std::int64_t steps) {
    block.march(steps);
  }
};
struct Avx512Lanes {
  using Number = Pack<8, 4>;
  template <class Block>
  __attribute__((target("avx512f,fma"), noinline, flatten)) static void march(Block& block, std::int64_t steps) {
    block.march(steps);
  }
};
#endif

/// @tparam Family the problem for any type of parameters   @tparam Set one of the structures above
/// @tparam watch whether to look at energy and invariants at every step, as runs do
template <template <class> class Family, class Set, bool watch = true>
class EnsembleBlockOf final : public EnsembleBlock {
 public:
  using Number = typename Set::Number;
  using P = Family<Number>;
  static constexpr std::size_t n = P::dimension;
  static constexpr bool has_invariants = HasInvariants<P, Number>;
  using Invariants = typename detail::InvariantsOf<P, Number>::type;

  EnsembleBlockOf(SplittingSequence<double> sequence, MethodInfo (*describe)(const void*), const void* table)
      : sequence_(std::move(sequence)), describe_(describe), table_(table) {}

  std::size_t lanes() const override { return Number::size; }

  bool load(const ParameterShape& shape, std::span<const MemberStart> members) override {
    const auto member = [&](std::size_t lane) -> const MemberStart& {
      return members[lane < members.size() ? lane : members.size() - 1];
    };
    Parameters<Number> parameters;
    std::size_t at = 0;
    for (const auto& [name, size] : shape) {
      if (size != 1) return false;  // no problem that lanes can take has lists
      Number value;
      for (std::size_t lane = 0; lane < Number::size; ++lane) value.set(lane, member(lane).parameters[at]);
      parameters.set(name, value);
      ++at;
    }
    Number h;
    Vector<Number, n> q{};
    Vector<Number, n> p{};
    for (std::size_t lane = 0; lane < Number::size; ++lane) {
      h.set(lane, member(lane).h);
      for (std::size_t i = 0; i < n; ++i) {
        q[i].set(lane, member(lane).q[i]);
        p[i].set(lane, member(lane).p[i]);
      }
    }
    // The scalar kernel multiplies every coefficient by h before it does anything else; that is done here once.
    SplittingSequence<Number> scaled{sequence_.starts_with, {}};
    for (const double c : sequence_.coefficients) scaled.coefficients.push_back(h * Number(c));
    if (scaled.ends_alike() != sequence_.ends_alike()) return false;  // h so small that all coefficients are 0
    parts_.emplace(Parts{P(parameters), Stepper(scaled, describe_, table_), {}, {}, {}});
    Parts& all = *parts_;
    all.z.store(q, p);
    all.watched.initial_energy = hamflow::energy(all.problem, q, p);
    all.scale = larger(abs(all.watched.initial_energy), abs(all.problem.kinetic(p)) + abs(all.problem.potential(q)));
    if constexpr (has_invariants) all.watched.initial = invariants_of(all.problem, all.z);
    for (auto& part : all.watched.regular.part) part = ~typename Number::Mask{};
    return true;
  }

  void advance(std::int64_t steps) override { Set::march(*this, steps); }

  /// The loop over steps, on copies that can stay in registers.
  [[gnu::always_inline]] void march(std::int64_t steps) {
    const P problem = parts_->problem;
    Stepper method = parts_->method;
    PhasePoint<Plain<Number>, n> z = parts_->z;
    Watched watched = parts_->watched;
    const Number one(1.0);  // h is in the coefficients
    for (std::int64_t i = 0; i < steps; ++i) {
      (void)method.step(problem, one, z);
      if constexpr (watch) look_at(problem, z, watched);
    }
    parts_->method = method;
    parts_->z = z;
    parts_->watched = watched;
  }

  MemberEnd look(std::size_t lane) override {
    const Parts& all = *parts_;
    const auto q = all.z.positions();
    const auto p = all.z.momenta();
    MemberEnd end;
    constexpr double most = std::numeric_limits<double>::max();
    const Number energy = hamflow::energy(all.problem, q, p);
    end.regular = all.watched.regular.get(lane) && std::abs(energy.get(lane)) <= most;
    for (std::size_t i = 0; i < n; ++i) {
      end.q.push_back(q[i].get(lane));
      end.p.push_back(p[i].get(lane));
      end.regular = end.regular && std::abs(end.q[i]) <= most && std::abs(end.p[i]) <= most;
    }
    end.energy = {all.watched.initial_energy.get(lane), energy.get(lane), all.watched.worst_energy.get(lane)};
    end.energy_scale = all.scale.get(lane);
    if constexpr (has_invariants) {
      const Invariants now = invariants_of(all.problem, all.z);
      for (std::size_t k = 0; k < now.size(); ++k) {
        end.invariants.push_back(
            {{all.watched.initial[k].get(lane)}, {now[k].get(lane)}, all.watched.worst[k].get(lane)});
      }
    }
    return end;
  }

 private:
  using Stepper = Splitting<P, Plain<Number>, Shape::any>;
  struct Watched {
    Number initial_energy, worst_energy;
    Invariants initial, worst;
    typename Number::Flags regular;
  };
  struct Parts {
    P problem;
    Stepper method;
    PhasePoint<Plain<Number>, n> z;
    Number scale;
    Watched watched;
  };

  [[gnu::always_inline]] static Invariants invariants_of(const P& problem, const PhasePoint<Plain<Number>, n>& z) {
    return problem.invariants(z.positions(), z.momenta(), Number(0.0));
  }
  /// ConservationProbe, lane by lane; what is not finite is remembered, and does not stop the others.
  [[gnu::always_inline]] static void look_at(const P& problem, const PhasePoint<Plain<Number>, n>& z, Watched& w) {
    const Number error = abs(hamflow::energy(problem, z.positions(), z.momenta()) - w.initial_energy);
    w.worst_energy = larger(w.worst_energy, error);
    w.regular.keep_where_finite(error);
    if constexpr (has_invariants) {
      static_assert(!HasInvariantSizes<P>, "hamflow: these lanes know invariants of one component each");
      const Invariants values = invariants_of(problem, z);
      for (std::size_t k = 0; k < values.size(); ++k) {
        w.worst[k] = larger(w.worst[k], abs(values[k] - w.initial[k]));
      }
    }
  }

  SplittingSequence<double> sequence_;
  MethodInfo (*describe_)(const void*);
  const void* table_;
  std::optional<Parts> parts_;
};

}  // namespace hamflow
