// The pair laws on a register of pairs at once, and their cut-offs. Included by kernel_body.hpp.

/// The contribution of a pair: c times the difference of positions to the force, phi to the energy.
struct Pair {
  Part c;
  Part phi;
};

/// numerator/u for two vectors with a single division, 1/a = b/(a b). The product is finite for squares of lengths
/// between 1e-150 and 1e150. Others give NaN, which is detected. The division begins early, so that its result is
/// available when it is needed.
struct Quotients {
  Part first;
  Part second;
  HAMFLOW_INLINE void begin(double numerator, const Part& a, const Part& b) { first = all<Part>(numerator) / (a * b); }
  HAMFLOW_INLINE void end(double, const Part& a, const Part& b) {
    second = first * a;
    first = first * b;
  }
};

// A pair law is a function of the result of `Inverses` for base(u).

struct LennardJones {
  using Inverses = Quotients;  // s = sigma^2/u
  static constexpr bool weighs = false;
  HAMFLOW_INLINE static double numerator(const Law& law) { return law.sigma_squared; }
  HAMFLOW_INLINE static Part base(const Law&, const Part& u) { return u; }
  HAMFLOW_INLINE static Pair of(const Law& law, const Part& s, const Part&) {
    const Part s2 = s * s;
    const Part s3 = s2 * s;
    return {(s2 * s2) * (s2 * s + all<Part>(-law.half_attraction)), s3 * (s3 - all<Part>(law.attraction))};
  }
};

struct Newton {
  static constexpr bool weighs = true;
  HAMFLOW_INLINE static double numerator(const Law&) { return 1; }
  HAMFLOW_INLINE static Part base(const Law& law, const Part& u) { return u + all<Part>(law.softening_squared); }
  using Inverses = Quotients;
  HAMFLOW_INLINE static Pair of(const Law&, const Part& s, const Part& w) {
    const Part pull = w * root(s);
    return {all<Part>(0) - pull * s, all<Part>(0) - pull};
  }
};

// Cut-offs change a pair as a function of u, the square of its distance.

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
    const Part phi = r * all<Part>(law.slope) + all<Part>(law.shift);
    return weighs ? Pair{w * c + pair.c, pair.phi - w * phi} : Pair{pair.c + c, pair.phi - phi};
  }
};
struct Smooth {
  HAMFLOW_INLINE static Pair of(const Law& law, const Part& u, const Part&, const Pair& pair, bool) {
    const Part x = not_below_zero((u - all<Part>(law.inner_squared)) * all<Part>(law.inverse_width));
    const Part x2 = x * x;
    const Part x4 = x2 * x2;
    Part s = all<Part>(-70) * x + all<Part>(315);
    s = s * x + all<Part>(-540);
    s = s * x + all<Part>(420);
    s = s * x + all<Part>(-126);
    s = s * (x4 * x) + all<Part>(1);
    const Part y = x * (all<Part>(1) - x);
    const Part y2 = y * y;
    const Part turn = y2 * y2;  // s' = -630 y^4
    return {pair.phi * all<Part>(law.turn_in_c) * turn + pair.c * s, pair.phi * s};
  }
};
