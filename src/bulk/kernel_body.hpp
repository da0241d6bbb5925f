// The kernels, compiled once for each instruction set: HAMFLOW_BULK_KERNELS names their table. Everything is local to
// this file, because an inline function of a library that is compiled here could be linked into other code.
#ifdef __AVX2__
#include <immintrin.h>  // without AVX2 the kernels use registers of 16 bytes, by the compiler's vectors alone
#endif

#include "kernel.hpp"

namespace hamflow::bulk {
namespace {

#include "eight.hpp"
#include "laws.hpp"

constexpr std::size_t most_lanes = 8;

/// Calls work(Index<0>), work(Index<1>), ... without a loop, so that indexed variables stay in registers.
template <int n>
struct Index {
  static constexpr int value = n;
  constexpr operator int() const { return n; }
};
template <int count, int at = 0, class Work>
HAMFLOW_INLINE void each(const Work& work) {
  if constexpr (at < count) {
    work(Index<at>{});
    each<count, at + 1>(work);
  }
}
/// Calls work(0), work(1), ... for the parts of eight numbers. Four parts of two numbers do not fit into the registers,
/// so they use a loop, with a quarter of the code.
template <class Work>
HAMFLOW_INLINE void each_part(const Work& work) {
  if constexpr (natives > 2) {
#pragma GCC unroll 1
    for (int n = 0; n < natives; ++n) work(n);
  } else {
    each<natives>(work);
  }
}

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

/// Rows i .. i + Tile - 1, which all visit the same partners, so that data of a partner are loaded and stored once for
/// all rows; and Width parts of their sums.
template <class L, int Space, bool Energy, int Tile, int Width>
struct RowTile {
  const Law& law;
  const double* at[Space];
  const double* w;
  double* felt[Space];
  Part centre[Tile][Space];
  Part weight[Tile];
  Part force[Tile][Width][Space];
  Part energy[Tile][Width];

  HAMFLOW_INLINE RowTile(const Rows& rows, const Law& of_pairs, std::size_t i, double* const (&forces)[Space])
      : law(of_pairs), w(rows.w) {
    for (int k = 0; k < Space; ++k) {
      at[k] = rows.x[k];
      felt[k] = forces[k];
    }
    each<Tile>([&](auto row) __attribute__((always_inline)) {
      constexpr int t = decltype(row)::value;
      for (int k = 0; k < Space; ++k) centre[t][k] = all<Part>(rows.x[k][i + t]);
      weight[t] = all<Part>(L::weighs ? rows.w[i + t] : 1);
      for (int n = 0; n < Width; ++n) {
        for (int k = 0; k < Space; ++k) force[t][n][k] = all<Part>(0);
        energy[t][n] = all<Part>(0);
      }
    });
  }
  /// Returns the differences of coordinate k from the partners j, j + 1, ...
  HAMFLOW_INLINE Part difference(int t, int k, std::size_t j) const { return centre[t][k] - load<Part>(at[k] + j); }
  /// Pairs of one row, computed as far as the slow division: a part from j on, and one from j + 8 on.
  struct PartialPairs {
    Part base[2];
    typename L::Inverses inverses;
  };
  /// @tparam Some whether only some pairs count   @param counts the masks of these pairs
  template <bool Some>
  HAMFLOW_INLINE PartialPairs begin(int t, std::size_t j, const Mask* counts) const {
    PartialPairs r;
    each<2>([&](auto half) __attribute__((always_inline)) {
      constexpr int h = decltype(half)::value;
      Part u;
      for (int k = 0; k < Space; ++k) {
        const Part d = difference(t, k, j + 8 * h);
        u = k == 0 ? d * d : d * d + u;
      }
      if constexpr (Some) u = where(counts[h], u, 1);
      r.base[h] = L::base(law, u);
    });
    r.inverses.begin(L::numerator(law), r.base[0], r.base[1]);
    return r;
  }
  /// Completes the pairs. Differences are computed again, which is faster than keeping them.
  template <bool Some>
  HAMFLOW_INLINE void end(PartialPairs begun, int t, int n, std::size_t j, Part (&feel)[2][Space], const Mask* counts) {
    begun.inverses.end(L::numerator(law), begun.base[0], begun.base[1]);
    each<2>([&](auto half) __attribute__((always_inline)) {
      constexpr int h = decltype(half)::value;
      const std::size_t there = j + 8 * h;
      const Part weights = L::weighs ? weight[t] * load<Part>(w + there) : weight[t];
      Pair pair = L::of(law, h == 0 ? begun.inverses.first : begun.inverses.second, weights);
      if constexpr (Some) pair = {where(counts[h], pair.c, 0), where(counts[h], pair.phi, 0)};
      for (int k = 0; k < Space; ++k) {
        const Part d = difference(t, k, there);
        force[t][n][k] = pair.c * d + force[t][n][k];
        if constexpr (Tile > 1) {
          feel[h][k] = feel[h][k] - pair.c * d;
        } else {
          store(load<Part>(felt[k] + there) - pair.c * d, felt[k] + there);
        }
      }
      if constexpr (Energy) energy[t][n] = energy[t][n] + pair.phi;
    });
  }
  /// Visits sixteen partners with all rows, one row after the other.
  /// @param bits for each row, which of the sixteen count; used only with Some
  /// @param part the index among the parts of the eight sums; it is the n-th of this tile
  template <bool Some>
  HAMFLOW_INLINE void visit(std::size_t j, int n, [[maybe_unused]] const unsigned* bits, [[maybe_unused]] int part) {
    Part feel[2][Space];
    for (int h = 0; h < 2; ++h) {
      for (int k = 0; Tile > 1 && k < Space; ++k) feel[h][k] = load<Part>(felt[k] + j + 8 * h);
    }
    each<Tile>([&](auto row) __attribute__((always_inline)) {
      constexpr int t = decltype(row)::value;
      Mask counts[2] = {};
      if constexpr (Some) {
        counts[0] = mask_of(bits[t], part);
        counts[1] = mask_of(bits[t] >> 8, part);
      }
      end<Some>(begin<Some>(t, j, counts), t, n, j, feel, counts);
    });
    for (int h = 0; h < 2; ++h) {
      for (int k = 0; Tile > 1 && k < Space; ++k) store(feel[h][k], felt[k] + j + 8 * h);
    }
  }
  /// Visits the sixteen partners from j on, of which only some count.
  HAMFLOW_INLINE void visit_masked(std::size_t j, const unsigned (&bits)[Tile], int first_part) {
    each<Width>([&](auto part) __attribute__((always_inline)) {
      constexpr int n = decltype(part)::value;
      visit<true>(j + static_cast<std::size_t>(n) * lanes, n, bits, first_part + n);
    });
  }
  /// Visits the partners first .. last - 1. Several rows overlap each other's divisions. A single row begins the next
  /// sixteen partners before it completes these, because the reorder window of a processor is shorter than this work.
  HAMFLOW_INLINE void visit_all(std::size_t first, std::size_t last) {
    if constexpr (Tile > 1) {
      for (std::size_t j = first; j < last; j += 16) visit<false>(j, 0, nullptr, 0);
    } else if (first < last) {
      const auto begin_at = [&](std::size_t j) __attribute__((always_inline)) { return begin<false>(0, j, nullptr); };
      PartialPairs begun[Width];
      for (int n = 0; n < Width; ++n) begun[n] = begin_at(first + static_cast<std::size_t>(n) * lanes);
      for (std::size_t j = first; j < last; j += 16) {
        const std::size_t after = j + 16 < last ? j + 16 : j;
        each<Width>([&](auto part) __attribute__((always_inline)) {
          constexpr int n = decltype(part)::value;
          constexpr std::size_t lane = static_cast<std::size_t>(n) * lanes;
          const PartialPairs next = begin_at(after + lane);
          Part none[2][Space];
          end<false>(begun[n], 0, n, j + lane, none, nullptr);
          begun[n] = next;
        });
      }
    }
  }
};

/// The number of rows that are visited together, limited by the number of registers.
template <int Space>
constexpr int rows_of_tile = natives > 1  ? 1
                             : Space == 2 ? 4
                                          : 2;
/// The number of parts that are summed together. Four parts of two numbers do not fit into the registers.
constexpr int parts_of_tile = natives > 2 ? 1 : natives;

/// Sums all pairs i < j of the rows i, each once. Partner j is added to the (j mod 8)-th partial sum of the row. The
/// opposite force is added to the forces of this block (Scratch), which are summed over blocks later.
template <class L, int Space, bool Energy>
std::uint64_t sum_all(const Rows& rows, std::size_t first, std::size_t last, const Candidates&,
                      const Scratch& scratch) {
  const Law law = rows.law;
  const std::size_t whole = rows.particles / 16 * 16;
  const unsigned rest = (1u << (rows.particles - whole)) - 1;
  double* force[Space];
  for (int k = 0; k < Space; ++k) force[k] = scratch.memory + static_cast<std::size_t>(k) * scratch.row;
  std::size_t i = first;
  while (i < last) {
    const std::size_t own = i / 16 * 16;
    const std::size_t end = own + 16 < last ? own + 16 : last;
    alignas(64) double own_force[Space][16] = {};  // added at the end, when no row of the sixteen reads forces any more
    const auto add_rows = [&](auto tile) __attribute__((always_inline)) {
      constexpr int Tile = decltype(tile)::value;
      constexpr int Width = parts_of_tile;
      unsigned bits[Tile];
      unsigned ends[Tile];
      for (unsigned r = 0; r < Tile; ++r) {
        bits[r] = (0xfffeu << (i + r - own)) & (own < whole ? 0xffff : rest);
        ends[r] = rest;
      }
      Sums<Space> sums[Tile];
#pragma GCC unroll 1
      for (int n = 0; n < natives; n += Width) {
        const std::size_t lane = static_cast<std::size_t>(n) * lanes;
        RowTile<L, Space, Energy, Tile, Width> t(rows, law, i, force);
        t.visit_masked(own + lane, bits, n);
        t.visit_all(own + 16 + lane, whole + lane);
        if (own < whole && rest != 0) t.visit_masked(whole + lane, ends, n);
        for (int r = 0; r < Tile; ++r) {
          for (int m = 0; m < Width; ++m) {
            for (int k = 0; k < Space; ++k) sums[r].force[k].v[n + m] = t.force[r][m][k].v[0];
            if constexpr (Energy) sums[r].energy.v[n + m] = t.energy[r][m].v[0];
          }
        }
      }
      for (std::size_t r = 0; r < Tile; ++r) {
        for (int k = 0; k < Space; ++k) own_force[k][i + r - own] = sum_of(sums[r].force[k]);
        if constexpr (Energy) rows.energy[i + r] = sum_of(sums[r].energy);
      }
      i += Tile;
    };
    constexpr int Tile = rows_of_tile<Space>;
    while (i + Tile <= end) add_rows(Index<Tile>{});
    if constexpr (Tile > 1) {
      while (i < end) add_rows(Index<1>{});
    }
    for (int k = 0; k < Space; ++k) {
      for (std::size_t j = 0; j < 16; j += 8)
        store(load(force[k] + own + j) + load(own_force[k] + j), force[k] + own + j);
    }
  }
  return 0;
}

/// Packs the differences and w of the neighbours in range of one row. It is not inlined, because it would be compiled a
/// hundred times within the kernels.
template <bool Weighs, int Space, bool Images>
[[gnu::noinline]] std::size_t pack(const Rows& rows, std::size_t i, const std::uint32_t* slots, std::size_t count,
                                   double* to, std::size_t stride) {
  Eight centre[Space];
  for (int k = 0; k < Space; ++k) centre[k] = all(rows.at[4 * i + static_cast<std::size_t>(k)]);
  const Eight limit = all(rows.law.cut_squared);
  std::size_t found = 0;
  for (std::size_t j = 0; j < count; j += most_lanes) {
    Eight x[4];
    load_slots<Space == 2 && !Weighs>(rows.at, slots + j, x[0], x[1], x[2], x[3]);
    Eight d[Space];
    Eight u = all(0);
    for (int k = 0; k < Space; ++k) {
      d[k] = centre[k] - x[k];
      if constexpr (Images) {
        const Eight image = nearest_whole(d[k] * all(rows.inverse_edge[k]));
        d[k] = d[k] - image * all(rows.edge[k]);
      }
      u = k == 0 ? d[k] * d[k] : d[k] * d[k] + u;
    }
    unsigned bits = below(u, limit);
    if (count - j < most_lanes) bits &= (1u << (count - j)) - 1;
    for (int k = 0; k < Space; ++k) append(bits, d[k], to + static_cast<std::size_t>(k) * stride + found);
    if constexpr (Weighs) append(bits, x[3], to + 3 * stride + found);
    found += static_cast<std::size_t>(__builtin_popcount(bits));
  }
  return found;
}

/// u and the differences of a part of eight pairs.
template <int Space>
struct Distance {
  Part u;
  Part d[Space];
};

/// Adds sixteen pairs of one row, or some of them. u is computed again with the same bits, which is faster than storing
/// it.
/// @tparam Halves 1 if all pairs that count are among the first eight; the others would add 0 and divide by u = 1
template <class L, class C, int Space, bool Energy, bool Some, int Halves>
HAMFLOW_INLINE void add_sixteen(const Law& law, const double* from, std::size_t stride, unsigned bits,
                                Sums<Space>& sums) {
  each_part([&](const auto n) __attribute__((always_inline)) {
    Distance<Space> r[2];
    r[1].u = all<Part>(1);
    Part w[2];
    Mask counts[2];
    each<Halves>([&](auto half) __attribute__((always_inline)) {
      constexpr int h = decltype(half)::value;
      counts[h] = mask_of(bits >> (8 * h), n);
      const double* const here = from + 8 * h + n * lanes;
      for (int k = 0; k < Space; ++k) {
        r[h].d[k] = load<Part>(here + static_cast<std::size_t>(k) * stride);
        if constexpr (Some) r[h].d[k] = where(counts[h], r[h].d[k], 0);  // unused memory may contain NaN
        r[h].u = k == 0 ? r[h].d[k] * r[h].d[k] : r[h].d[k] * r[h].d[k] + r[h].u;
      }
      if constexpr (Some) r[h].u = where(counts[h], r[h].u, 1);
      w[h] = L::weighs ? load<Part>(here + 3 * stride) : all<Part>(1);
    });
    typename L::Inverses s;
    s.begin(L::numerator(law), L::base(law, r[0].u), L::base(law, r[1].u));
    s.end(L::numerator(law), L::base(law, r[0].u), L::base(law, r[1].u));
    each<Halves>([&](auto half) __attribute__((always_inline)) {
      constexpr int h = decltype(half)::value;
      Pair pair = C::of(law, r[h].u, w[h], L::of(law, h == 0 ? s.first : s.second, w[h]), L::weighs);
      if constexpr (Some) pair = {where(counts[h], pair.c, 0), where(counts[h], pair.phi, 0)};
      for (int k = 0; k < Space; ++k) {
        sums.force[k].v[n] = (pair.c * r[h].d[k] + Part{{sums.force[k].v[n]}}).v[0];
      }
      if constexpr (Energy) sums.energy.v[n] = sums.energy.v[n] + pair.phi.v[0];
    });
  });
}

/// Sums neighbours in range with lists. The k-th neighbour is added to the (k mod 8)-th partial sum. While one row is
/// summed, the next one is packed, so that no load waits for a recent store.
template <class L, class C, int Space, bool Energy>
std::uint64_t sum_listed(const Rows& rows, std::size_t first, std::size_t last, const Candidates& candidates,
                         const Scratch& scratch) {
  const Law law = rows.law;
  std::uint64_t pairs = 0;
  const auto packed_row = [&](std::size_t i) __attribute__((always_inline)) {
    const std::size_t row = i - first;
    double* const to = scratch.memory + (row % 2) * 4 * scratch.row;
    const std::uint32_t* const slots = candidates.slots + candidates.begins[row];
    const std::size_t count = candidates.counts[row];
    return rows.plain[i] ? pack<L::weighs, Space, false>(rows, i, slots, count, to, scratch.row)
                         : pack<L::weighs, Space, true>(rows, i, slots, count, to, scratch.row);
  };
  std::size_t next = first < last ? packed_row(first) : 0;
  for (std::size_t i = first; i < last; ++i) {
    const double* const from = scratch.memory + ((i - first) % 2) * 4 * scratch.row;
    const std::size_t count = next;
    if (i + 1 < last) next = packed_row(i + 1);
    pairs += count;
    Sums<Space> sums = nothing<Space>();
    std::size_t j = 0;
    for (; j + 16 <= count; j += 16) {
      add_sixteen<L, C, Space, Energy, false, 2>(law, from + j, scratch.row, 0xffff, sums);
    }
    const unsigned bits = (1u << (count - j)) - 1;
    if (j + 8 < count) {
      add_sixteen<L, C, Space, Energy, true, 2>(law, from + j, scratch.row, bits, sums);
    } else if (j < count) {
      add_sixteen<L, C, Space, Energy, true, 1>(law, from + j, scratch.row, bits, sums);
    }
    const std::size_t particle = rows.number[i];
    const double strength = rows.times_strength ? rows.at[4 * i + 3] : 1;
    for (int k = 0; k < Space; ++k) {
      rows.force[particle * Space + static_cast<std::size_t>(k)] =
          sum_of(sums.force[k]) * (rows.force_factor * strength);
    }
    if constexpr (Energy) rows.energy[particle] = sum_of(sums.energy) * strength;
  }
  return pairs;
}

template <int Space, bool Images>
std::size_t find_near(const CandidateParticles& candidates, std::size_t one, std::uint32_t* found) {
  std::uint32_t* to = found;
  const Eight limit = all(candidates.radius_squared);
  Eight centre[Space];
  for (int k = 0; k < Space; ++k) centre[k] = all(candidates.x[k][one]);
  for (std::size_t j = 0; j < candidates.count; j += most_lanes) {
    Eight u = all(0);
    for (int k = 0; k < Space; ++k) {
      Eight d = centre[k] - load(candidates.x[k] + j);
      if constexpr (Images) d = d - nearest_whole(d * all(candidates.inverse_edge[k])) * all(candidates.edge[k]);
      u = u + d * d;
    }
    unsigned bits = below(u, limit);
    if (candidates.count - j < most_lanes) bits &= (1u << (candidates.count - j)) - 1;
    if (one - j < most_lanes) bits &= ~(1u << (one - j));
    append(bits, candidates.slots + j, to);
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
