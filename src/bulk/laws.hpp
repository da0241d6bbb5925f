// The pair laws on eight pairs at once, and what a cut-off makes of them. Included by kernel_body.hpp.

/// What a pair adds: c times the difference of positions to the force, phi to the energy.
struct Pair {
  Eight c;
  Eight phi;
};

#define HAMFLOW_ESTIMATES (HAMFLOW_BULK_FAST && HAMFLOW_NATIVE_BYTES == 64)

/// numerator/u of two vectors. One division serves both, 1/a = b/(a b): it takes longer than all else of a pair.
/// Squares of lengths between 1e-150 and 1e150 have such a product; others give no number, which is found. What is
/// begun early is there when it is wanted.
struct Quotients {
  Eight first;
  Eight second;
  HAMFLOW_INLINE void begin([[maybe_unused]] double numerator, const Eight& a, const Eight& b) {
#if HAMFLOW_ESTIMATES
    second = a * b;
    first.v[0] = (Native)_mm512_rcp14_pd((__m512d)second.v[0]);
#else
    first = all(numerator) / (a * b);
#endif
  }
  HAMFLOW_INLINE void end([[maybe_unused]] double numerator, const Eight& a, const Eight& b) {
#if HAMFLOW_ESTIMATES
    // y (1 + e + e^2 + e^3) with y = 1/u to 14 digits: what is left is e^4 < 2^-56.
    const Eight e = minus_times(all(1), second, first);
    const Eight y = all(numerator) * first;
    first = times_plus(y, times_plus(e, times_plus(e, e, e), e), y);
#endif
    second = first * a;
    first = first * b;
  }
};

#if HAMFLOW_ESTIMATES
/// u^(-1/2): y (1 - e)^(-1/2) with y an estimate of 14 digits and e = 1 - u y^2, up to e^3: what is left is below
/// 2^-53.
struct InverseRoots {
  Eight first;
  Eight second;
  HAMFLOW_INLINE void begin(double, const Eight& a, const Eight& b) {
    first.v[0] = (Native)_mm512_rsqrt14_pd((__m512d)a.v[0]);
    second.v[0] = (Native)_mm512_rsqrt14_pd((__m512d)b.v[0]);
  }
  HAMFLOW_INLINE void end(double, const Eight& a, const Eight& b) {
    first = refined(a, first);
    second = refined(b, second);
  }
  HAMFLOW_INLINE static Eight refined(const Eight& u, const Eight& y) {
    const Eight e = minus_times(all(1), u, y * y);
    const Eight series = times_plus(e, times_plus(e, all(5.0 / 16), all(3.0 / 8)), all(1.0 / 2));
    return times_plus(y * e, series, y);
  }
};
#endif

// A pair law is a function of what `Inverses` makes of base(u).

struct LennardJones {
  using Inverses = Quotients;  // s = sigma^2/u
  static constexpr bool weighs = false;
  HAMFLOW_INLINE static double numerator(const Law& law) { return law.sigma_squared; }
  HAMFLOW_INLINE static Eight base(const Law&, const Eight& u) { return u; }
  HAMFLOW_INLINE static Pair of(const Law& law, const Eight& s, const Eight&) {
    const Eight s2 = s * s;
    const Eight s3 = s2 * s;
    return {(s2 * s2) * (s3 - all(law.half_attraction)), s3 * (s3 - all(law.attraction))};
  }
};

struct Newton {
  static constexpr bool weighs = true;
  HAMFLOW_INLINE static double numerator(const Law&) { return 1; }
  HAMFLOW_INLINE static Eight base(const Law& law, const Eight& u) { return u + all(law.softening_squared); }
#if HAMFLOW_ESTIMATES
  using Inverses = InverseRoots;
  HAMFLOW_INLINE static Pair of(const Law&, const Eight& y, const Eight& w) {
    const Eight pull = w * y;
    return {all(0) - pull * (y * y), all(0) - pull};
  }
#else
  using Inverses = Quotients;
  HAMFLOW_INLINE static Pair of(const Law&, const Eight& s, const Eight& w) {
    const Eight pull = w * root(s);
    return {all(0) - pull * s, all(0) - pull};
  }
#endif
};

// Cut-offs: what becomes of a pair at the square u of its distance.

struct Uncut {
  HAMFLOW_INLINE static Pair of(const Law&, const Eight&, const Eight&, const Pair& pair, bool) { return pair; }
};
struct Shifted {
  HAMFLOW_INLINE static Pair of(const Law& law, const Eight&, const Eight& w, const Pair& pair, bool weighs) {
    const Eight shift = weighs ? w * all(law.shift) : all(law.shift);
    return {pair.c, pair.phi - shift};
  }
};
struct ForceShifted {
  HAMFLOW_INLINE static Pair of(const Law& law, const Eight& u, const Eight& w, const Pair& pair, bool weighs) {
    const Eight r = root(u);
    const Eight c = all(law.slope_in_c) / r;
    const Eight phi = times_plus(r, all(law.slope), all(law.shift));
    return weighs ? Pair{times_plus(w, c, pair.c), minus_times(pair.phi, w, phi)} : Pair{pair.c + c, pair.phi - phi};
  }
};
struct Smooth {
  HAMFLOW_INLINE static Pair of(const Law& law, const Eight& u, const Eight&, const Pair& pair, bool) {
    const Eight x = not_below_zero((u - all(law.inner_squared)) * all(law.inverse_width));
    const Eight x2 = x * x;
    const Eight x4 = x2 * x2;
    Eight s = times_plus(all(-70), x, all(315));
    s = times_plus(s, x, all(-540));
    s = times_plus(s, x, all(420));
    s = times_plus(s, x, all(-126));
    s = times_plus(s, x4 * x, all(1));
    const Eight y = x * (all(1) - x);
    const Eight y2 = y * y;
    const Eight turn = y2 * y2;  // s' = -630 y^4
    return {times_plus(pair.phi * all(law.turn_in_c), turn, pair.c * s), pair.phi * s};
  }
};
