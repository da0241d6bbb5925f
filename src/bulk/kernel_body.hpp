// The kernels, compiled once for each instruction set: HAMFLOW_BULK_KERNELS names their table, HAMFLOW_BULK_FAST is 0
// or
// 1. Everything is of this file alone: an inline function of a library, compiled here, could be linked elsewhere.
#include <immintrin.h>

#include "kernel.hpp"

namespace hamflow::bulk {
namespace {

#include "eight.hpp"
#include "laws.hpp"

constexpr std::size_t most_lanes = 8;

/// The partial sums of one row.
template <int Space>
struct Sums {
  Eight force[Space];
  Eight energy;
};

template <int Space>
HAMFLOW_INLINE Sums<Space> nothing() {
  Sums<Space> sums;
  for (int k = 0; k < Space; ++k) sums.force[k] = all(0);
  sums.energy = all(0);
  return sums;
}
template <int Space, bool Energy>
HAMFLOW_INLINE void add(const Pair& pair, const Eight (&d)[Space], Sums<Space>& sums) {
  for (int k = 0; k < Space; ++k) sums.force[k] = times_plus(pair.c, d[k], sums.force[k]);
  if constexpr (Energy) sums.energy = sums.energy + pair.phi;
}
template <int Space, bool Energy>
HAMFLOW_INLINE void write(const Rows& rows, std::size_t particle, double w, const Sums<Space>& sums) {
  const double strength = rows.times_strength ? w : 1;
  for (int k = 0; k < Space; ++k) {
    rows.force[particle * Space + k] = sum_of(sums.force[k]) * (rows.force_factor * strength);
  }
  if constexpr (Energy) rows.energy[particle] = sum_of(sums.energy) * strength;
}

/// u and the differences of eight pairs.
template <int Space>
struct Distance {
  Eight u;
  Eight d[Space];
};

/// Sixteen pairs.
template <class L, class C, int Space, bool Energy>
struct Sixteen {
  Distance<Space> a;
  Distance<Space> b;
  Eight weights_a;
  Eight weights_b;
  typename L::Inverses s;

  HAMFLOW_INLINE void begin(const Law& law) { s.begin(L::numerator(law), L::base(law, a.u), L::base(law, b.u)); }
  HAMFLOW_INLINE void end(const Law& law, Sums<Space>& sums) {
    s.end(L::numerator(law), L::base(law, a.u), L::base(law, b.u));
    add<Space, Energy>(C::of(law, a.u, weights_a, L::of(law, s.first, weights_a), L::weighs), a.d, sums);
    add<Space, Energy>(C::of(law, b.u, weights_b, L::of(law, s.second, weights_b), L::weighs), b.d, sums);
  }
  /// Those whose bits are set; what the others hold does not count.
  HAMFLOW_INLINE void add_some(const Law& law, unsigned bits, Sums<Space>& sums) {
    a.u = where(bits, a.u, 1);
    b.u = where(bits >> 8, b.u, 1);
    begin(law);
    s.end(L::numerator(law), L::base(law, a.u), L::base(law, b.u));
    Pair pair = C::of(law, a.u, weights_a, L::of(law, s.first, weights_a), L::weighs);
    add<Space, Energy>({where(bits, pair.c, 0), where(bits, pair.phi, 0)}, a.d, sums);
    pair = C::of(law, b.u, weights_b, L::of(law, s.second, weights_b), L::weighs);
    add<Space, Energy>({where(bits >> 8, pair.c, 0), where(bits >> 8, pair.phi, 0)}, b.d, sums);
  }
};

/// All pairs i < j of the rows i, each once: j is added to the (j mod 8)-th partial sum of the row, and what it feels
/// to the forces of these rows (Scratch), which are summed over rows later.
template <class L, int Space, bool Energy>
std::uint64_t sum_all(const Rows& rows, std::size_t first, std::size_t last, const Candidates&,
                      const Scratch& scratch) {
  const Law law = rows.law;
  const std::size_t whole = rows.particles / 16 * 16;
  double* force[Space];
  for (int k = 0; k < Space; ++k) force[k] = scratch.memory + static_cast<std::size_t>(k) * scratch.row;
  for (std::size_t i = first; i < last; ++i) {
    Eight centre[Space];
    for (int k = 0; k < Space; ++k) centre[k] = all(rows.x[k][i]);
    const Eight own_weight = all(L::weighs ? rows.w[i] : 1);
    Sums<Space> sums = nothing<Space>();
    const auto at = [&](std::size_t j) __attribute__((always_inline)) {
      Distance<Space> r;
      for (int k = 0; k < Space; ++k) {
        r.d[k] = centre[k] - load(rows.x[k] + j);
        r.u = k == 0 ? r.d[k] * r.d[k] : times_plus(r.d[k], r.d[k], r.u);
      }
      return r;
    };
    const auto weights = [&](std::size_t j) __attribute__((always_inline)) {
      return L::weighs ? own_weight * load(rows.w + j) : own_weight;
    };
    const auto both = [&](std::size_t j, const Pair& pair, const Distance<Space>& r) __attribute__((always_inline)) {
      for (int k = 0; k < Space; ++k) {
        const Eight other = load(force[k] + j);
#if HAMFLOW_BULK_FAST
        sums.force[k] = times_plus(pair.c, r.d[k], sums.force[k]);
        store(minus_times(other, pair.c, r.d[k]), force[k] + j);
#else
        const Eight push = pair.c * r.d[k];
        sums.force[k] = sums.force[k] + push;
        store(other - push, force[k] + j);
#endif
      }
      if constexpr (Energy) sums.energy = sums.energy + pair.phi;
    };
    const auto visit_some = [&](std::size_t j, unsigned bits) {
      Distance<Space> a = at(j);
      Distance<Space> b = at(j + 8);
      a.u = where(bits, a.u, 1);
      b.u = where(bits >> 8, b.u, 1);
      typename L::Inverses s;
      s.begin(L::numerator(law), L::base(law, a.u), L::base(law, b.u));
      s.end(L::numerator(law), L::base(law, a.u), L::base(law, b.u));
      Pair pair = L::of(law, s.first, weights(j));
      both(j, {where(bits, pair.c, 0), where(bits, pair.phi, 0)}, a);
      pair = L::of(law, s.second, weights(j + 8));
      both(j + 8, {where(bits >> 8, pair.c, 0), where(bits >> 8, pair.phi, 0)}, b);
    };
    const std::size_t own = i / 16 * 16;
    const unsigned later = (0xfffeu << (i - own)) & 0xffff;
    const unsigned rest = (1u << (rows.particles - whole)) - 1;
    visit_some(own, own < whole ? later : later & rest);
    for (std::size_t j = own + 16; j < whole; j += 16) {
      const Distance<Space> a = at(j);
      const Distance<Space> b = at(j + 8);
      typename L::Inverses s;
      s.begin(L::numerator(law), L::base(law, a.u), L::base(law, b.u));
      s.end(L::numerator(law), L::base(law, a.u), L::base(law, b.u));
      both(j, L::of(law, s.first, weights(j)), a);
      both(j + 8, L::of(law, s.second, weights(j + 8)), b);
    }
    if (own < whole && rest != 0) visit_some(whole, rest);
    for (int k = 0; k < Space; ++k) force[k][i] += sum_of(sums.force[k]);
    if constexpr (Energy) rows.energy[i] = sum_of(sums.energy);
  }
  return 0;
}

/// Those in range of one row, moved together.
template <class L, int Space, bool Images>
HAMFLOW_INLINE std::size_t pack(const Rows& rows, std::size_t i, const std::uint32_t* slots, std::size_t count,
                                double* to, std::size_t stride) {
  Eight centre[Space];
  for (int k = 0; k < Space; ++k) centre[k] = all(rows.at[4 * i + static_cast<std::size_t>(k)]);
  const Eight limit = all(rows.law.cut_squared);
  std::size_t found = 0;
  for (std::size_t j = 0; j < count; j += most_lanes) {
    Eight x[4];
    load_slots(rows.at, slots + j, x[0], x[1], x[2], x[3]);
    Eight d[Space];
    Eight u = all(0);
    for (int k = 0; k < Space; ++k) {
      d[k] = centre[k] - x[k];
      if constexpr (Images) {
        const Eight image = nearest_whole(d[k] * all(rows.inverse_edge[k]));
        d[k] = minus_times(d[k], image, all(rows.edge[k]));
      }
      u = k == 0 ? d[k] * d[k] : times_plus(d[k], d[k], u);
    }
    unsigned bits = below(u, limit);
    if (count - j < most_lanes) bits &= (1u << (count - j)) - 1;
    append(bits, u, to + found);
    for (int k = 0; k < Space; ++k) append(bits, d[k], to + static_cast<std::size_t>(k + 1) * stride + found);
    if constexpr (L::weighs) append(bits, x[3], to + 4 * stride + found);
    found += static_cast<std::size_t>(__builtin_popcount(bits));
  }
  return found;
}

/// Neighbours in range by lists: the k-th is added to the (k mod 8)-th partial sum. While one row is summed the next
/// one is packed, so that what is read was written some time ago.
template <class L, class C, int Space, bool Energy>
std::uint64_t sum_listed(const Rows& rows, std::size_t first, std::size_t last, const Candidates& candidates,
                         const Scratch& scratch) {
  const Law law = rows.law;
  std::uint64_t pairs = 0;
  const auto packed_row = [&](std::size_t i) __attribute__((always_inline)) {
    const std::size_t row = i - first;
    double* const to = scratch.memory + (row % 2) * 5 * scratch.row;
    const std::uint32_t* const slots = candidates.slots + candidates.begins[row];
    const std::size_t count = candidates.counts[row];
    return rows.plain[i] ? pack<L, Space, false>(rows, i, slots, count, to, scratch.row)
                         : pack<L, Space, true>(rows, i, slots, count, to, scratch.row);
  };
  std::size_t next = first < last ? packed_row(first) : 0;
  for (std::size_t i = first; i < last; ++i) {
    const double* const from = scratch.memory + ((i - first) % 2) * 5 * scratch.row;
    const std::size_t count = next;
    if (i + 1 < last) next = packed_row(i + 1);
    pairs += count;
    Sums<Space> sums = nothing<Space>();
    const auto at = [&](std::size_t j) __attribute__((always_inline)) {
      Distance<Space> r;
      r.u = load(from + j);
      for (int k = 0; k < Space; ++k) r.d[k] = load(from + static_cast<std::size_t>(k + 1) * scratch.row + j);
      return r;
    };
    const auto weights = [&](std::size_t j) __attribute__((always_inline)) {
      return L::weighs ? load(from + 4 * scratch.row + j) : all(1);
    };
    const auto sixteen = [&](std::size_t j) __attribute__((always_inline)) {
      return Sixteen<L, C, Space, Energy>{at(j), at(j + 8), weights(j), weights(j + 8), {}};
    };
    std::size_t j = 0;
    for (; j + 16 <= count; j += 16) {
      auto now = sixteen(j);
      now.begin(law);
      now.end(law, sums);
    }
    if (j < count) {
      const unsigned bits = (1u << (count - j)) - 1;
      auto rest = sixteen(j);
      for (int k = 0; k < Space; ++k) {  // what was there before may be no number
        rest.a.d[k] = where(bits, rest.a.d[k], 0);
        rest.b.d[k] = where(bits >> 8, rest.b.d[k], 0);
      }
      rest.add_some(law, bits, sums);
    }
    write<Space, Energy>(rows, rows.number[i], L::weighs ? rows.at[4 * i + 3] : 1, sums);
  }
  return pairs;
}

template <int Space, bool Images>
std::size_t find_near(const Crowd& crowd, std::size_t one, std::uint32_t* found) {
  std::uint32_t* to = found;
  const Eight limit = all(crowd.radius_squared);
  Eight centre[Space];
  for (int k = 0; k < Space; ++k) centre[k] = all(crowd.x[k][one]);
  for (std::size_t j = 0; j < crowd.count; j += most_lanes) {
    Eight u = all(0);
    for (int k = 0; k < Space; ++k) {
      Eight d = centre[k] - load(crowd.x[k] + j);
      if constexpr (Images) d = d - nearest_whole(d * all(crowd.inverse_edge[k])) * all(crowd.edge[k]);
      u = u + d * d;
    }
    unsigned bits = below(u, limit);
    if (crowd.count - j < most_lanes) bits &= (1u << (crowd.count - j)) - 1;
    if (one - j < most_lanes) bits &= ~(1u << (one - j));
    append(bits, crowd.slots + j, to);
    to += __builtin_popcount(bits);
  }
  return static_cast<std::size_t>(to - found);
}

#define HAMFLOW_WITH_ENERGY(kernel, ...) \
  { kernel<__VA_ARGS__, false>, kernel<__VA_ARGS__, true> }
#define HAMFLOW_IN_SPACES(kernel, ...) \
  { HAMFLOW_WITH_ENERGY(kernel, __VA_ARGS__, 2), HAMFLOW_WITH_ENERGY(kernel, __VA_ARGS__, 3) }
#define HAMFLOW_CUT(law)                                                                           \
  {                                                                                                \
    HAMFLOW_IN_SPACES(sum_listed, law, Shifted), HAMFLOW_IN_SPACES(sum_listed, law, ForceShifted), \
        HAMFLOW_IN_SPACES(sum_listed, law, Smooth)                                                 \
  }

}  // namespace

const Kernels HAMFLOW_BULK_KERNELS = {
    {HAMFLOW_IN_SPACES(sum_all, LennardJones), HAMFLOW_IN_SPACES(sum_all, Newton)},
    {HAMFLOW_CUT(LennardJones), HAMFLOW_CUT(Newton)},
    {{find_near<2, false>, find_near<2, true>}, {find_near<3, false>, find_near<3, true>}}};

}  // namespace hamflow::bulk
