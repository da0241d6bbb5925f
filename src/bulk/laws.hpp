// The pair laws on a register of pairs at once, and what a cut-off makes of them. Included by kernel_body.hpp.

/// What a pair adds: c times the difference of positions to the force, phi to the energy.
struct Pair {
  Part c;
  Part phi;
};

#define HAMFLOW_ESTIMATES (HAMFLOW_BULK_FAST && HAMFLOW_NATIVE_BYTES == 64)

/// numerator/u of two vectors. One division serves both, 1/a = b/(a b), in kernel fast too: beside the other operations
/// of sixteen pairs it takes no time, while an estimate and its series are five of them. Squares of lengths between
/// 1e-150 and 1e150 have such a product; others give no number, which is found. What is begun early is there when it is
/// wanted.
struct Quotients {
  Part first;
  Part second;
  HAMFLOW_INLINE void begin(double numerator, const Part& a, const Part& b) { first = all<Part>(numerator) / (a * b); }
  HAMFLOW_INLINE void end(double, const Part& a, const Part& b) {
    second = first * a;
    first = first * b;
  }
};

#if HAMFLOW_ESTIMATES
/// u^(-1/2): y (1 - e)^(-1/2) with y an estimate of 14 digits and e = 1 - u y^2, up to e^3: what is left is below
/// 2^-53.
struct InverseRoots {
  Part first;
  Part second;
  HAMFLOW_INLINE void begin(double, const Part& a, const Part& b) {
    first.v[0] = (Native)_mm512_rsqrt14_pd((__m512d)a.v[0]);
    second.v[0] = (Native)_mm512_rsqrt14_pd((__m512d)b.v[0]);
  }
  HAMFLOW_INLINE void end(double, const Part& a, const Part& b) {
    first = refined(a, first);
    second = refined(b, second);
  }
  HAMFLOW_INLINE static Part refined(const Part& u, const Part& y) {
    const Part e = minus_times(all<Part>(1), u, y * y);
    const Part series = times_plus(e, times_plus(e, all<Part>(5.0 / 16), all<Part>(3.0 / 8)), all<Part>(1.0 / 2));
    return times_plus(y * e, series, y);
  }
};
#endif

// A pair law is a function of what `Inverses` makes of base(u).

struct LennardJones {
  using Inverses = Quotients;  // s = sigma^2/u
  static constexpr bool weighs = false;
  HAMFLOW_INLINE static double numerator(const Law& law) { return law.sigma_squared; }
  HAMFLOW_INLINE static Part base(const Law&, const Part& u) { return u; }
  HAMFLOW_INLINE static Pair of(const Law& law, const Part& s, const Part&) {
    const Part s2 = s * s;
    const Part s3 = s2 * s;
    return {(s2 * s2) * times_plus(s2, s, all<Part>(-law.half_attraction)), s3 * (s3 - all<Part>(law.attraction))};
  }
};

struct Newton {
  static constexpr bool weighs = true;
  HAMFLOW_INLINE static double numerator(const Law&) { return 1; }
  HAMFLOW_INLINE static Part base(const Law& law, const Part& u) { return u + all<Part>(law.softening_squared); }
#if HAMFLOW_ESTIMATES
  using Inverses = InverseRoots;
  HAMFLOW_INLINE static Pair of(const Law&, const Part& y, const Part& w) {
    const Part pull = w * y;
    return {all<Part>(0) - pull * (y * y), all<Part>(0) - pull};
  }
#else
  using Inverses = Quotients;
  HAMFLOW_INLINE static Pair of(const Law&, const Part& s, const Part& w) {
    const Part pull = w * root(s);
    return {all<Part>(0) - pull * s, all<Part>(0) - pull};
  }
#endif
};

// Cut-offs: what becomes of a pair at the square u of its distance.

struct Uncut {
  HAMFLOW_INLINE static Pair of(const Law&, const Part&, const Part&, const Pair& pair, bool) { return pair; }
};
struct Shifted {
  HAMFLOW_INLINE static Pair of(const Law& law, const Part&, const Part& w, const Pair& pair, bool weighs) {
    const Part shift = weighs ? w * all<Part>(law.shift) : all<Part>(law.shift);
    return {pair.c, pair.phi - shift};
  }
};
struct ForceShifted {
  HAMFLOW_INLINE static Pair of(const Law& law, const Part& u, const Part& w, const Pair& pair, bool weighs) {
    const Part r = root(u);
    const Part c = all<Part>(law.slope_in_c) / r;
    const Part phi = times_plus(r, all<Part>(law.slope), all<Part>(law.shift));
    return weighs ? Pair{times_plus(w, c, pair.c), minus_times(pair.phi, w, phi)} : Pair{pair.c + c, pair.phi - phi};
  }
};
struct Smooth {
  HAMFLOW_INLINE static Pair of(const Law& law, const Part& u, const Part&, const Pair& pair, bool) {
    const Part x = not_below_zero((u - all<Part>(law.inner_squared)) * all<Part>(law.inverse_width));
    const Part x2 = x * x;
    const Part x4 = x2 * x2;
    Part s = times_plus(all<Part>(-70), x, all<Part>(315));
    s = times_plus(s, x, all<Part>(-540));
    s = times_plus(s, x, all<Part>(420));
    s = times_plus(s, x, all<Part>(-126));
    s = times_plus(s, x4 * x, all<Part>(1));
    const Part y = x * (all<Part>(1) - x);
    const Part y2 = y * y;
    const Part turn = y2 * y2;  // s' = -630 y^4
    return {times_plus(pair.phi * all<Part>(law.turn_in_c), turn, pair.c * s), pair.phi * s};
  }
};
