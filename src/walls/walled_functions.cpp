#include "walled_functions.hpp"

#include <cmath>
#include <limits>

#include "engine/carried.hpp"
#include "engine/forwarding_functions.hpp"
#include "walled_problem.hpp"

namespace hamflow {

namespace {

/// Data shared by all functions of a problem; B is the type of its parameters.
template <class B>
struct WallTerms {
  struct Soft {
    std::size_t coordinate = 0;
    B middle{};
    B half_width{};
    B inverse_width{};  // 1/half_width
  };
  std::vector<Soft> soft;
  B strength{};
  B exponent{};
  int whole_exponent = 0;  // 0: not a whole number
  std::vector<WallSide<B>> mirrors;
  std::vector<bool> kept;  // for each invariant; empty: all are kept
};

template <class S, class B>
class WalledFunctions final : public ForwardingFunctions<S> {
  using Base = ForwardingFunctions<S>;
  using Base::exact_;

 public:
  using typename Base::M;
  using typename Base::V;
  WalledFunctions(typename Base::Pointer inner, std::shared_ptr<const WallTerms<B>> walls)
      : Base(std::move(inner)), walls_(std::move(walls)) {}

  S energy(const V& q, const V& p) const override {
    if (walls_->mirrors.empty()) return with_walls(exact_->energy(q, p), q);
    V x = q;
    V y = p;
    const Turned turned = mirrored_inside(x);
    turn(turned, y);
    return exact_->energy(x, y);
  }
  S potential(const V& q) const override {
    V x = q;
    (void)mirrored_inside(x);
    return with_walls(exact_->potential(x), x);
  }
  void force(const V& q, V& f) const override {
    V x = q;
    const Turned turned = mirrored_inside(x);
    exact_->force(x, f);
    turn(turned, f);
    add_forces(x, f, nullptr);
  }
  bool has_scaled_force() const override { return walls_->soft.empty() && exact_->has_scaled_force(); }
  void scaled_force(const S& factor, const V& q, V& f) const override {
    V x = q;
    const Turned turned = mirrored_inside(x);
    exact_->scaled_force(factor, x, f);
    turn(turned, f);
  }
  void gradient(const V& q, const V& p, V& dq, V& dp) const override {
    V x = q;
    V y = p;
    const Turned turned = mirrored_inside(x);
    turn(turned, y);
    exact_->gradient(x, y, dq, dp);
    turn(turned, dq);
    turn(turned, dp);
    for (const auto& wall : walls_->soft) dq[wall.coordinate] = dq[wall.coordinate] - at(wall, q).force;
  }
  void hessian(const V& q, const V& p, M& qq, M& qp, M& pp) const override {
    V x = q;
    V y = p;
    const Turned turned = mirrored_inside(x);
    turn(turned, y);
    exact_->hessian(x, y, qq, qp, pp);
    for (M* m : {&qq, &qp, &pp}) turn(turned, *m);
    add_second(q, qq);
  }
  void force_and_hessian(const V& q, V& f, M& h) const override {
    V x = q;
    const Turned turned = mirrored_inside(x);
    exact_->force_and_hessian(x, f, h);
    turn(turned, f);
    turn(turned, h);
    add_forces(x, f, &h);
  }
  V invariants(const V& q, const V& p, const S& t) const override {
    const V all = exact_->invariants(q, p, t);
    if (walls_->kept.empty()) return all;
    std::size_t at = 0;
    std::vector<S> left;
    const auto sizes = exact_->invariant_sizes();
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      for (std::size_t i = 0; i < sizes[k]; ++i, ++at) {
        if (walls_->kept[k]) left.push_back(all[at]);
      }
    }
    V out = zeros<S, dynamic>(left.size());
    for (std::size_t i = 0; i < left.size(); ++i) out[i] = left[i];
    return out;
  }
  std::vector<std::size_t> invariant_sizes() const override {
    std::vector<std::size_t> sizes = exact_->invariant_sizes();
    for (std::size_t k = walls_->kept.size(); k-- > 0;) {
      if (!walls_->kept[k]) sizes.erase(sizes.begin() + static_cast<std::ptrdiff_t>(k));
    }
    return sizes;
  }

 private:
  using Soft = typename WallTerms<B>::Soft;
  struct Term {
    S potential;
    S force;
    S second;
  };

  /// V = k w/(2 (e - 1)) (1 - x^2)^(1 - e), for e = 1 -(k w/2) ln(1 - x^2), and its force -k x/(1 - x^2)^e.
  Term at(const Soft& wall, const V& q) const {
    const B& k = walls_->strength;
    const B& e = walls_->exponent;
    const S x = (q[wall.coordinate] - S(wall.middle)) * S(wall.inverse_width);
    const S u = S(B(1)) - x * x;
    if (!cannot_branch(u) && !(S(B(0)) < u)) {
      OutsideNote::note(static_cast<std::size_t>(&wall - walls_->soft.data()));
      const S none(std::numeric_limits<B>::quiet_NaN());
      return {none, none, none};
    }
    // One division serves all powers: in lanes the divisions for e = 6 took four fifths of a step.
    const S inverse = S(B(1)) / u;
    const S power =
        walls_->whole_exponent > 0 ? whole_power(inverse, walls_->whole_exponent) : S(exp(S(B(-e)) * log(u)));
    const B half = k * wall.half_width / B(2);
    const S potential = e == B(1) ? S(S(B(-half)) * log(u)) : S(S(B(half / (e - B(1)))) * (power * u));
    const S second = S(B(k / wall.half_width)) * (power + S(B(B(2) * e)) * (x * x) * (power * inverse));
    return {potential, -(S(k) * x * power), second};
  }
  /// Whether S is a Taylor series, which cannot branch; the check is made at the ends of its steps.
  static bool cannot_branch(const S& u) {
    if constexpr (requires { u.is_exact(); }) {
      return !u.is_exact();  // in exact recordings comparisons are guards
    } else {
      return false;
    }
  }
  S with_walls(S energy, const V& q) const {
    for (const Soft& wall : walls_->soft) energy = energy + at(wall, q).potential;
    return energy;
  }
  void add_forces(const V& q, V& f, M* h) const {
    for (const Soft& wall : walls_->soft) {
      const Term term = at(wall, q);
      f[wall.coordinate] = f[wall.coordinate] + term.force;
      if (h != nullptr) (*h)[wall.coordinate][wall.coordinate] = (*h)[wall.coordinate][wall.coordinate] + term.second;
    }
  }
  void add_second(const V& q, M& qq) const {
    for (const Soft& wall : walls_->soft) {
      qq[wall.coordinate][wall.coordinate] = qq[wall.coordinate][wall.coordinate] + at(wall, q).second;
    }
  }

  static constexpr bool is_traced = detail::IsTrace<S>::value;
  /// Which coordinates are mirrored; for traces a number above 0 means mirrored.
  using Turned = std::vector<std::conditional_t<is_traced, S, bool>>;

  /// Maps q back between the mirrors.
  Turned mirrored_inside(V& q) const {
    Turned turned;
    if (walls_->mirrors.empty()) return turned;
    if constexpr (is_traced) {
      return mirrored_once(q);
    } else {
      return folded_often(q);
    }
  }
  /// Reflects once. A recording does not cover steps that are still beyond a wall afterwards.
  Turned mirrored_once(V& q) const {
    Turned turned(q.size(), S(B(0)));
    for (const WallSide<B>& wall : walls_->mirrors) {
      const std::size_t i = wall.coordinate;
      const S beyond = wall.side > 0 ? S(q[i] - S(wall.at)) : S(S(wall.at) - q[i]);
      q[i] = choose(beyond, S(S(B(B(2) * wall.at)) - q[i]), q[i]);
      turned[i] = choose(beyond, S(S(B(1)) - turned[i]), turned[i]);
    }
    for (const WallSide<B>& wall : walls_->mirrors) {
      const S& x = q[wall.coordinate];
      if (wall.side > 0 ? S(wall.at) < x : x < S(wall.at)) throw CannotRecord("a mirrored step ends far beyond a wall");
    }
    return turned;
  }
  Turned folded_often(V& q) const {
    Turned turned(q.size(), false);
    constexpr int most = 1000;
    bool beyond = true;
    for (int n = 0; beyond && n < most; ++n) {
      beyond = false;
      for (const WallSide<B>& wall : walls_->mirrors) {
        S& x = q[wall.coordinate];
        if (!(wall.side > 0 ? S(wall.at) < x : x < S(wall.at))) continue;
        x = S(B(B(2) * wall.at)) - x;
        turned[wall.coordinate] = !turned[wall.coordinate];
        beyond = true;
      }
    }
    return turned;
  }
  static void turn(const Turned& turned, V& x) {
    for (std::size_t i = 0; i < turned.size(); ++i) {
      if constexpr (is_traced) {
        x[i] = choose(turned[i], S(-x[i]), x[i]);
      } else if (turned[i]) {
        x[i] = -x[i];
      }
    }
  }
  static void turn(const Turned& turned, M& m) {
    for (std::size_t i = 0; i < turned.size(); ++i) {
      for (std::size_t j = 0; j < turned.size(); ++j) {
        if constexpr (is_traced) {
          const S differ = turned[i] - turned[j];
          m[i][j] = choose(S(differ * differ), S(-m[i][j]), m[i][j]);
        } else if (turned[i] != turned[j]) {
          m[i][j] = -m[i][j];
        }
      }
    }
  }

  std::shared_ptr<const WallTerms<B>> walls_;
};

template <class S, class B>
std::shared_ptr<const Functions<S>> behind(std::shared_ptr<const Functions<S>> functions,
                                           const std::shared_ptr<const WallTerms<B>>& walls) {
  if (!functions) return functions;
  return std::make_shared<const WalledFunctions<S, B>>(std::move(functions), walls);
}

}  // namespace

template <class R>
ErasedFunctions<R> functions_with_walls(const ErasedFunctions<R>& functions, const Request& request, const Walls& walls,
                                        const std::vector<WallSide<R>>& sides) {
  auto terms = std::make_shared<WallTerms<R>>();
  terms->kept = kept_invariants(request, walls);
  const bool breaks = std::find(terms->kept.begin(), terms->kept.end(), false) != terms->kept.end();
  if (!breaks) terms->kept.clear();
  if (walls.rule == WallRule::soft) {
    for (const Walls::Interval& i : walls.intervals) {
      const R min = evaluate_number<R>(i.min);
      const R max = evaluate_number<R>(i.max);
      terms->soft.push_back({i.index, (min + max) / R(2), (max - min) / R(2), R(2) / (max - min)});
    }
    terms->strength = evaluate_number<R>(walls.strength);
    terms->exponent = evaluate_number<R>(walls.exponent);
    const double e = evaluate_number<double>(walls.exponent);
    if (e == std::floor(e) && e <= 64) terms->whole_exponent = static_cast<int>(e);
  }
  if (walls.rule == WallRule::mirror) terms->mirrors = sides;
  ErasedFunctions<R> other = functions;
  if (!breaks && terms->soft.empty() && terms->mirrors.empty()) return other;
  const std::shared_ptr<const WallTerms<R>> shared = std::move(terms);
  other.plain = behind<R, R>(functions.plain, shared);
  other.trace = behind<Trace<R>, R>(functions.trace, shared);
  if constexpr (std::is_same_v<R, double>) other.dual = behind<Dual<double, 1>, double>(functions.dual, shared);
  // Exact results for the motion without walls do not hold here.
  if (!shared->soft.empty() || !shared->mirrors.empty()) {
    constexpr Capability left = Capability::separable | Capability::quadratic_kinetic;
    other.capability =
        static_cast<Capability>(static_cast<unsigned>(functions.capability) & static_cast<unsigned>(left));
  }
  return other;
}

#define HAMFLOW_WITH_WALLS(R)                                                                                  \
  template ErasedFunctions<R> functions_with_walls<R>(const ErasedFunctions<R>&, const Request&, const Walls&, \
                                                      const std::vector<WallSide<R>>&);
HAMFLOW_WITH_WALLS(double)
HAMFLOW_WITH_WALLS(long double)
HAMFLOW_WITH_WALLS(DoubleDouble)
HAMFLOW_WITH_WALLS(Quad)
HAMFLOW_WITH_WALLS(Mp)
#undef HAMFLOW_WITH_WALLS

}  // namespace hamflow
