// The pair laws on eight pairs at once, and what a cut-off makes of them. Included by kernel_body.hpp.

/// What a pair adds: c times the difference of positions to the force, phi to the energy.
struct Pair {
  Eight c;
  Eight phi;
};

/// numerator/u. One division serves two vectors, 1/a = b/(a b): it takes longer than all else of a pair. Squares of
/// lengths between 1e-150 and 1e150 have such a product; others give no number, which is found.
struct Two {
  Eight first;
  Eight second;
};
HAMFLOW_INLINE Eight over(double numerator, const Eight& u) {
#if HAMFLOW_BULK_FAST && HAMFLOW_NATIVE_BYTES == 64
  // y (1 + e + e^2 + e^3) with y = 1/u to 14 digits: what is left is e^4 < 2^-56.
  const Eight y{{(Native)_mm512_rcp14_pd((__m512d)u.v[0])}};
  const Eight e = minus_times(all(1), u, y);
  const Eight y1 = all(numerator) * y;
  return times_plus(y1, times_plus(e, times_plus(e, e, e), e), y1);
#else
  return all(numerator) / u;
#endif
}
HAMFLOW_INLINE Two over(double numerator, const Two& u) {
#if HAMFLOW_BULK_FAST && HAMFLOW_NATIVE_BYTES == 64
  return {over(numerator, u.first), over(numerator, u.second)};
#else
  const Eight t = all(numerator) / (u.first * u.second);
  return {t * u.second, t * u.first};
#endif
}

/// phi and c of s: both laws are functions of numerator/(u + added).
struct LennardJones {
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
  HAMFLOW_INLINE static Pair of(const Law&, const Eight& s, const Eight& w) {
    const Eight pull = w * root(s);
    return {all(0) - pull * s, all(0) - pull};
  }
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
