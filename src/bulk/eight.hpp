// Eight numbers (Eight) in as many registers as the instruction set needs, and the numbers of one register (Part). Each
// instruction set does the same operations in the same order. Included by kernel_body.hpp, within the namespace of an
// instruction set.

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define HAMFLOW_NATIVE_BYTES 64
#elif defined(__AVX2__)
#define HAMFLOW_NATIVE_BYTES 32
#else
#define HAMFLOW_NATIVE_BYTES 16
#endif
#define HAMFLOW_INLINE [[gnu::always_inline]] inline

typedef double Native __attribute__((vector_size(HAMFLOW_NATIVE_BYTES)));
typedef long long NativeBits __attribute__((vector_size(HAMFLOW_NATIVE_BYTES)));
constexpr int lanes = HAMFLOW_NATIVE_BYTES / 8;
constexpr int natives = 8 / lanes;

/// Long computations run part by part, because all eight numbers need too many registers.
template <int N>
struct Group {
  Native v[N];
};
using Eight = Group<natives>;
using Part = Group<1>;
#define HAMFLOW_EACH for (int n = 0; n < N; ++n)

template <class G = Eight>
HAMFLOW_INLINE G all(double x) {
  G r;
  for (auto& v : r.v) v = x - Native{};
  return r;
}
template <class G = Eight>
HAMFLOW_INLINE G load(const double* from) {
  G r;
  for (auto& v : r.v) {
    __builtin_memcpy(&v, from, sizeof v);
    from += lanes;
  }
  return r;
}
template <int N>
HAMFLOW_INLINE void store(const Group<N>& x, double* to) {
  HAMFLOW_EACH __builtin_memcpy(to + n * lanes, &x.v[n], sizeof(Native));
}
template <int N>
HAMFLOW_INLINE Group<N> operator+(const Group<N>& a, const Group<N>& b) {
  Group<N> r;
  HAMFLOW_EACH r.v[n] = a.v[n] + b.v[n];
  return r;
}
template <int N>
HAMFLOW_INLINE Group<N> operator-(const Group<N>& a, const Group<N>& b) {
  Group<N> r;
  HAMFLOW_EACH r.v[n] = a.v[n] - b.v[n];
  return r;
}
template <int N>
HAMFLOW_INLINE Group<N> operator*(const Group<N>& a, const Group<N>& b) {
  Group<N> r;
  HAMFLOW_EACH r.v[n] = a.v[n] * b.v[n];
  return r;
}
template <int N>
HAMFLOW_INLINE Group<N> operator/(const Group<N>& a, const Group<N>& b) {
  Group<N> r;
  HAMFLOW_EACH r.v[n] = a.v[n] / b.v[n];
  return r;
}
template <int N>
HAMFLOW_INLINE Group<N> root(const Group<N>& a) {
  Group<N> r;
#if HAMFLOW_NATIVE_BYTES == 64
  HAMFLOW_EACH r.v[n] = (Native)_mm512_sqrt_pd((__m512d)a.v[n]);
#elif HAMFLOW_NATIVE_BYTES == 32
  HAMFLOW_EACH r.v[n] = (Native)_mm256_sqrt_pd((__m256d)a.v[n]);
#else
  HAMFLOW_EACH r.v[n] = Native{__builtin_sqrt(a.v[n][0]), __builtin_sqrt(a.v[n][1])};
#endif
  return r;
}
/// Returns max(x, 0). NaN stays NaN.
template <int N>
HAMFLOW_INLINE Group<N> not_below_zero(const Group<N>& x) {
  Group<N> r;
#if HAMFLOW_NATIVE_BYTES == 64
  HAMFLOW_EACH r.v[n] = (Native)_mm512_max_pd(_mm512_setzero_pd(), (__m512d)x.v[n]);
#elif HAMFLOW_NATIVE_BYTES == 32
  HAMFLOW_EACH r.v[n] = (Native)_mm256_max_pd(_mm256_setzero_pd(), (__m256d)x.v[n]);
#else
  HAMFLOW_EACH r.v[n] = (Native)((NativeBits)x.v[n] & ~(x.v[n] < Native{}));
#endif
  return r;
}
/// Rounds |x| < 2^51 to the nearest whole number.
HAMFLOW_INLINE Eight nearest_whole(const Eight& x) {
  const Eight large = all(0x1.8p52);
  return (x + large) - large;
}

/// Returns eight bits: a bit is set unless x >= limit, so also for NaN.
HAMFLOW_INLINE unsigned below(const Eight& x, const Eight& limit) {
#if HAMFLOW_NATIVE_BYTES == 64
  return _mm512_cmp_pd_mask((__m512d)x.v[0], (__m512d)limit.v[0], _CMP_NGE_UQ);
#else
  unsigned bits = 0;
#if HAMFLOW_NATIVE_BYTES == 32
  for (int n = 0; n < natives; ++n)
    bits |= (unsigned)_mm256_movemask_pd(_mm256_cmp_pd((__m256d)x.v[n], (__m256d)limit.v[n], _CMP_NGE_UQ))
            << (n * lanes);
#else
  for (int n = 0; n < natives; ++n)
    for (int k = 0; k < lanes; ++k) bits |= (unsigned)!(x.v[n][k] >= limit.v[n][k]) << (n * lanes + k);
#endif
  return bits;
#endif
}

/// A mask that selects numbers of a part.
#if HAMFLOW_NATIVE_BYTES == 64
using Mask = __mmask8;
#else
using Mask = NativeBits;
struct Masks {
  long long of[1 << lanes][lanes];
};
constexpr Masks every_mask() {
  Masks m{};
  for (int bits = 0; bits < 1 << lanes; ++bits) {
    for (int k = 0; k < lanes; ++k) m.of[bits][k] = -((bits >> k) & 1);
  }
  return m;
}
alignas(HAMFLOW_NATIVE_BYTES) constexpr Masks masks = every_mask();
#endif
/// @param bits the selection among eight numbers @param part the index of the part
HAMFLOW_INLINE Mask mask_of(unsigned bits, [[maybe_unused]] int part) {
#if HAMFLOW_NATIVE_BYTES == 64
  return (Mask)bits;
#else
  Mask mask;
  __builtin_memcpy(&mask, masks.of[(bits >> (part * lanes)) & ((1u << lanes) - 1)], sizeof mask);
  return mask;
#endif
}
/// Selects x where the mask is set, else `other`.
HAMFLOW_INLINE Part where(Mask mask, const Part& x, double other) {
#if HAMFLOW_NATIVE_BYTES == 64
  return {{(Native)_mm512_mask_mov_pd(_mm512_set1_pd(other), mask, (__m512d)x.v[0])}};
#else
  return {{(Native)(((NativeBits)x.v[0] & mask) | ((NativeBits)(other - Native{}) & ~mask))}};
#endif
}

typedef double Four __attribute__((vector_size(32)));
typedef double Two __attribute__((vector_size(16)));

/// Adds the numbers in the order ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7)).
HAMFLOW_INLINE double sum_of(const Eight& x) {
#if HAMFLOW_NATIVE_BYTES == 16
  const Two two = (x.v[0] + x.v[2]) + (x.v[1] + x.v[3]);
#else
#if HAMFLOW_NATIVE_BYTES == 64
  const Four four =
      __builtin_shufflevector(x.v[0], x.v[0], 0, 1, 2, 3) + __builtin_shufflevector(x.v[0], x.v[0], 4, 5, 6, 7);
#else
  const Four four = x.v[0] + x.v[1];
#endif
  const Two two = __builtin_shufflevector(four, four, 0, 1) + __builtin_shufflevector(four, four, 2, 3);
#endif
  return two[0] + two[1];
}
#if HAMFLOW_NATIVE_BYTES == 32
/// Tables of permutations that pack the numbers selected by four bits: as halves of doubles, and as 32-bit numbers.
struct Packing {
  int halves[16][8];
  int wholes[16][4];
};
constexpr Packing packing() {
  Packing p{};
  for (int bits = 0; bits < 16; ++bits) {
    int to = 0;
    for (int k = 0; k < 4; ++k) {
      if ((bits >> k) & 1) {
        p.halves[bits][2 * to] = 2 * k;
        p.halves[bits][2 * to + 1] = 2 * k + 1;
        p.wholes[bits][to] = k;
        ++to;
      }
    }
  }
  return p;
}
alignas(32) constexpr Packing packed = packing();
#endif

/// Appends the numbers whose bits are set, in order. @param to has space for eight numbers
HAMFLOW_INLINE void append(unsigned bits, const Eight& x, double* to) {
#if HAMFLOW_NATIVE_BYTES == 64
  _mm512_storeu_pd(to, _mm512_maskz_compress_pd((__mmask8)bits, (__m512d)x.v[0]));
#elif HAMFLOW_NATIVE_BYTES == 32
  for (int n = 0; n < natives; ++n) {
    const unsigned four = (bits >> (4 * n)) & 15;
    const __m256i halves = _mm256_load_si256((const __m256i*)packed.halves[four]);
    _mm256_storeu_si256((__m256i*)to, _mm256_permutevar8x32_epi32((__m256i)x.v[n], halves));
    to += __builtin_popcount(four);
  }
#else
  for (int k = 0; k < 8; ++k) {
    *to = x.v[k / lanes][k % lanes];
    to += (bits >> k) & 1;
  }
#endif
}

HAMFLOW_INLINE void append(unsigned bits, const std::uint32_t* from, std::uint32_t* to) {
#if HAMFLOW_NATIVE_BYTES == 64
  const __m256i x = _mm256_loadu_si256((const __m256i*)from);
  _mm256_storeu_si256((__m256i*)to, _mm256_maskz_compress_epi32((__mmask8)bits, x));
#elif HAMFLOW_NATIVE_BYTES == 32
  for (int n = 0; n < 2; ++n) {
    const unsigned four = (bits >> (4 * n)) & 15;
    const __m128i wholes = _mm_load_si128((const __m128i*)packed.wholes[four]);
    const __m128 x = _mm_castsi128_ps(_mm_loadu_si128((const __m128i*)(from + 4 * n)));
    _mm_storeu_si128((__m128i*)to, _mm_castps_si128(_mm_permutevar_ps(x, wholes)));
    to += __builtin_popcount(four);
  }
#else
  for (int k = 0; k < 8; ++k) {
    *to = from[k];
    to += (bits >> k) & 1;
  }
#endif
}

/// Loads x, y, z, w of eight slots.
/// @tparam Two whether only x and y are needed; z and w may then be left unchanged
template <bool Two>
HAMFLOW_INLINE void load_slots(const double* at, const std::uint32_t* slots, Eight& x, Eight& y, Eight& z, Eight& w) {
  const auto row = [&](int k) { return at + 4 * (std::size_t)slots[k]; };
#if HAMFLOW_NATIVE_BYTES == 64
  const auto two = [&](int low, int high) {
    return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(row(low))), _mm256_load_pd(row(high)), 1);
  };
  const __m512d a = two(0, 4);  // x0 y0 z0 w0 x4 y4 z4 w4
  const __m512d b = two(1, 5);
  const __m512d c = two(2, 6);
  const __m512d d = two(3, 7);
  const __m512d xz = _mm512_unpacklo_pd(a, b);  // x0 x1 z0 z1 x4 x5 z4 z5
  const __m512d yw = _mm512_unpackhi_pd(a, b);
  const __m512d xz2 = _mm512_unpacklo_pd(c, d);  // x2 x3 z2 z3 x6 x7 z6 z7
  const __m512d yw2 = _mm512_unpackhi_pd(c, d);
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
  const __m512i high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  x.v[0] = (Native)_mm512_permutex2var_pd(xz, low, xz2);
  y.v[0] = (Native)_mm512_permutex2var_pd(yw, low, yw2);
  z.v[0] = (Native)_mm512_permutex2var_pd(xz, high, xz2);
  w.v[0] = (Native)_mm512_permutex2var_pd(yw, high, yw2);
#elif HAMFLOW_NATIVE_BYTES == 32
  for (int n = 0; n < natives; ++n) {
    if constexpr (Two) {
      const auto two = [&](int low, int high) {
        return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_load_pd(row(low))), _mm_load_pd(row(high)), 1);
      };
      const __m256d a = two(4 * n, 4 * n + 2);  // x0 y0 x2 y2
      const __m256d b = two(4 * n + 1, 4 * n + 3);
      x.v[n] = (Native)_mm256_unpacklo_pd(a, b);
      y.v[n] = (Native)_mm256_unpackhi_pd(a, b);
      continue;
    }
    const __m256d a = _mm256_load_pd(row(4 * n));
    const __m256d b = _mm256_load_pd(row(4 * n + 1));
    const __m256d c = _mm256_load_pd(row(4 * n + 2));
    const __m256d d = _mm256_load_pd(row(4 * n + 3));
    const __m256d xz = _mm256_unpacklo_pd(a, b);  // x0 x1 z0 z1
    const __m256d yw = _mm256_unpackhi_pd(a, b);
    const __m256d xz2 = _mm256_unpacklo_pd(c, d);
    const __m256d yw2 = _mm256_unpackhi_pd(c, d);
    x.v[n] = (Native)_mm256_permute2f128_pd(xz, xz2, 0x20);
    y.v[n] = (Native)_mm256_permute2f128_pd(yw, yw2, 0x20);
    z.v[n] = (Native)_mm256_permute2f128_pd(xz, xz2, 0x31);
    w.v[n] = (Native)_mm256_permute2f128_pd(yw, yw2, 0x31);
  }
#else
  for (int n = 0; n < natives; ++n) {
    const double* const a = row(2 * n);
    const double* const b = row(2 * n + 1);
    x.v[n] = Native{a[0], b[0]};
    y.v[n] = Native{a[1], b[1]};
    z.v[n] = Native{a[2], b[2]};
    w.v[n] = Native{a[3], b[3]};
  }
#endif
}
