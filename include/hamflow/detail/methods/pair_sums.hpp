// A kick on the lattice from forces between pairs: each pair's contribution is rounded to the lattice of momenta, added
// to one body and subtracted from the other, and the integers are summed. The sum depends neither on the order of the
// pairs nor on which thread adds them, so that any number of threads gives the same bits; the total momentum is
// conserved exactly; and since the rounding is odd, a kick of -h exactly reverses a kick of h.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/core/thread_team.hpp"

namespace hamflow {

/// Forces on single bodies, in addition to those of pairs: single_kicks(factor, position, sink) calls sink(i, r) where
/// factor times such a force adds r to p_i; position(k) is the k-th coordinate.
template <class P, class F = typename P::Real>
concept HasSingleKicks = requires(const P& problem, const F& factor, F (*position)(std::size_t),
                                  void (*sink)(std::size_t, const F&)) {
  problem.single_kicks(factor, position, sink);
};

/// Lists of the pairs that may contribute: near_pairs(position, team) returns rows, near[i].size() pairs in row i, with
/// a version() that changes with them; pair_kicks takes it as its last argument.
template <class P>
concept HasNearPairs = requires(const P& problem, double (*position)(std::size_t), ThreadTeam* team) {
  problem.near_pairs(position, team);
};

/// The kick of pair forces. Copies share their threads and take turns.
template <class P, Arithmetic A>
requires PairwiseForces<P> && IntegerSums<A>
class PairSums {
 public:
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Stored = typename A::Stored;

  void use_threads(std::size_t count) { group_ = count > 1 ? std::make_shared<ThreadGroup>(count) : nullptr; }

  /// kick <- factor F(q), rounded pair by pair.
  /// @return false if a contribution is too large; `kick` is then undefined
  template <class F>
  [[gnu::noinline]] bool evaluate(const P& problem, const F& factor, const PhasePoint<A, n>& z,
                                  Vector<Stored, n>& kick) const {
    const auto visit = [&](const auto& near, std::size_t first, std::size_t last, Sink& sink) {
      if constexpr (HasNearPairs<P>) {
        problem.pair_kicks(factor, Difference{z}, first, last, sink, near);
      } else {
        problem.pair_kicks(factor, Difference{z}, first, last, sink);
      }
    };
    const bool pairs = sum(problem, z, kick, visit);
    if constexpr (has_singles<F>) {
      Sink sink{z.arithmetic, limit(problem), kick.begin()};
      problem.single_kicks(
          factor, [&](std::size_t i) { return z.arithmetic.position.read(z.q[i]); },
          [&](std::size_t i, const Real& r) { sink.add(i, r); });
      return pairs && !sink.lost;
    } else {
      return pairs;
    }
  }
  /// kick <- first F(q) - third V''(q) v, rounded pair by pair.
  template <class F>
  [[gnu::noinline]] bool evaluate_with_gradient(const P& problem, const F& first, const F& third,
                                                const Vector<Real, n>& v, const PhasePoint<A, n>& z,
                                                Vector<Stored, n>& kick) const {
    return sum(problem, z, kick, [&](const auto& /*near*/, std::size_t from, std::size_t to, Sink& sink) {
      problem.pair_gradient_kicks(first, third, v, Difference{z}, from, to, sink);
    });
  }

 private:
  struct Difference {
    const PhasePoint<A, n>& z;
    Real operator()(std::size_t a, std::size_t b) const { return z.arithmetic.position.difference(z.q[a], z.q[b]); }
  };
  struct Sink {
    const A& arithmetic;
    Real limit;
    Stored* sums;
    bool lost = false;
    void operator()(std::size_t up, std::size_t down, const Real& r) {
      Stored k = 0;
      if (!arithmetic.momentum.units(r, limit, k)) [[unlikely]]
        lost = true;
      sums[up] += k;
      sums[down] -= k;
    }
    void add(std::size_t i, const Real& r) {
      Stored k = 0;
      if (!arithmetic.momentum.units(r, limit, k)) [[unlikely]]
        lost = true;
      sums[i] += k;
    }
  };
  /// Whether there are forces on single bodies (HasSingleKicks).
  template <class F>
  static constexpr bool has_singles = HasSingleKicks<P, F>;
  /// A power of two that bounds each contribution, such that all contributions to a coordinate together stay below
  /// 2^62. No partial sum can then overflow, in any order, and the refusal of a kick does not depend on the order.
  static Real limit(const P& problem) {
    const std::size_t singles = has_singles<Real> ? 1 : 0;
    return std::ldexp(Real(1), 62 - static_cast<int>(std::bit_width(problem.pair_rows() + singles)));
  }

  /// The sum of one thread in the last call in which it took part.
  struct alignas(64) Share {
    std::uint64_t call = 0;
    bool lost = false;
    std::vector<Stored> sums;
  };
  struct ThreadGroup {
    explicit ThreadGroup(std::size_t count) : team(count), shares(count) {}
    std::mutex busy;
    std::vector<std::size_t> rows;  // where each block begins, and the end
    std::uint64_t version = 0;      // of the lists that the blocks divide
    ThreadTeam team;
    std::vector<Share> shares;
  };

  /// All pairs, for a problem without lists.
  struct EveryPair {
    struct Row {
      std::size_t pairs;
      std::size_t size() const { return pairs; }
    };
    const P& problem;
    Row operator[](std::size_t i) const { return {problem.pairs_in_row(i)}; }
    static std::uint64_t version() { return 0; }
  };
  static auto pairs_at(const P& problem, [[maybe_unused]] const PhasePoint<A, n>& z,
                       [[maybe_unused]] ThreadTeam* team) {
    if constexpr (HasNearPairs<P>) {
      return problem.near_pairs([&](std::size_t i) { return z.arithmetic.position.read(z.q[i]); }, team);
    } else {
      return EveryPair{problem};
    }
  }

  /// @param visit (near, first, last, sink): passes the contributions of these rows to the sink
  template <class Visit>
  bool sum(const P& problem, const PhasePoint<A, n>& z, Vector<Stored, n>& kick, const Visit& visit) const {
    if (group_) return sum_by_many(problem, z, kick, visit);
    for (Stored& k : kick) k = 0;
    Sink sink{z.arithmetic, limit(problem), kick.begin()};
    visit(pairs_at(problem, z, nullptr), 0, problem.pair_rows(), sink);
    return !sink.lost;
  }
  template <class Visit>
  bool sum_by_many(const P& problem, const PhasePoint<A, n>& z, Vector<Stored, n>& kick, const Visit& visit) const {
    ThreadGroup& group = *group_;
    const std::lock_guard turn(group.busy);
    const auto near = pairs_at(problem, z, &group.team);
    if (group.shares[0].sums.size() != kick.size()) {
      group.rows.clear();
      for (Share& share : group.shares) share = {0, false, std::vector<Stored>(kick.size())};
    }
    if (group.rows.empty() || group.rows.back() != problem.pair_rows() || group.version != near.version()) {
      divide(near, problem.pair_rows(), group);
    }
    const Real most = limit(problem);
    auto work = [&](std::size_t worker, std::uint64_t call, std::size_t block) {
      Share& share = group.shares[worker];
      if (share.call != call) {
        share.call = call;
        share.lost = false;
        std::fill(share.sums.begin(), share.sums.end(), Stored{0});
      }
      Sink sink{z.arithmetic, most, share.sums.data()};
      visit(near, group.rows[block], group.rows[block + 1], sink);
      share.lost = share.lost || sink.lost;
    };
    const std::uint64_t call = group.team.share(group.rows.size() - 1, work);
    for (Stored& k : kick) k = 0;
    bool lost = false;
    for (const Share& share : group.shares) {
      if (share.call != call) continue;
      lost = lost || share.lost;
      for (std::size_t i = 0; i < kick.size(); ++i) kick[i] += share.sums[i];
    }
    return !lost;
  }

  /// Divides the rows into blocks with about equal numbers of pairs, several for each thread, so that a late thread
  /// does not delay the others.
  template <class Near>
  static void divide(const Near& near, std::size_t rows, ThreadGroup& group) {
    constexpr std::size_t blocks_each = 4;
    std::size_t pairs = 0;
    for (std::size_t row = 0; row < rows; ++row) pairs += near[row].size();
    const std::size_t each = pairs / (blocks_each * group.team.size()) + 1;
    group.version = near.version();
    group.rows.reserve(blocks_each * group.team.size() + 2);
    group.rows.assign(1, 0);
    std::size_t held = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      held += near[row].size();
      if (held >= each || row + 1 == rows) {
        group.rows.push_back(row + 1);
        held = 0;
      }
    }
  }

  std::shared_ptr<ThreadGroup> group_;
};

namespace detail {
/// Takes the place of PairSums in a kernel that does not sum integers; its kicks are floating-point numbers.
struct NoPairSums {};
template <class P, class A, bool sums_integers>
struct PairSumsOf {
  using type = NoPairSums;
  using Increment = typename A::Real;
};
template <class P, class A>
struct PairSumsOf<P, A, true> {
  using type = PairSums<P, A>;
  using Increment = typename A::Stored;
};
}  // namespace detail

}  // namespace hamflow
