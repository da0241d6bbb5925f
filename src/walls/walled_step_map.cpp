#include "walled_step_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "hamflow/verify/extrapolated_midpoint.hpp"
#include "walled_functions.hpp"

namespace hamflow {

namespace {

template <class R>
Vector<R, dynamic> part_of(const State<R>& z, std::size_t first, std::size_t size) {
  Vector<R, dynamic> x(size);
  for (std::size_t i = 0; i < size; ++i) x[i] = z[first + i];
  return x;
}

/// The problem with the H of the walls: soft walls are a term of H; beyond a mirror H continues as its image.
ErasedProblem problem_with_walls(const ErasedProblem& problem, const Request& request, const Walls& walls) {
  const auto behind = [&]<class R>(const ErasedFunctions<R>& functions) {
    return functions_with_walls(functions, request, walls,
                                walls.hard() ? wall_sides<R>(walls) : std::vector<WallSide<R>>());
  };
  return {behind(problem.in_double), behind(problem.in_long), behind(problem.in_quad)};
}

/// The claims of a method that hold with bounces. The time of a located bounce depends on the state, and a rejection
/// reverses a momentum without moving its coordinate, so neither is symplectic. Mirrors and rejections have an error of
/// first order in the step.
MethodInfo claims_with_walls(const Walls& walls, MethodInfo claims) {
  claims.name += " + " + wall_rules()[static_cast<std::size_t>(walls.rule)];
  if (walls.rule != WallRule::mirror) claims.symplectic = false;
  if (walls.rule == WallRule::event) return claims;
  claims.order = std::min(claims.order, 1);
  claims.energy_conserving = Conservation::no;
  if (walls.rule == WallRule::reject) claims.symmetric = claims.reversible = claims.weakly_reversible = false;
  return claims;
}

/// Steps are taken by simulations with walls; tangent vectors follow the branch that these take.
class WalledStepMap final : public StepMap {
  using V = Vector<double, dynamic>;
  using Tangents = std::vector<State<double>>;

 public:
  WalledStepMap(const ErasedProblem& problem, const Request& request, const Walls& walls, MakeStepMap make)
      : problem_(problem),
        request_(request),
        walls_(walls),
        free_(make(walls.rule == WallRule::mirror ? problem_with_walls(problem, request, walls) : problem,
                   request.method)),
        size_(problem.in_double.size) {
    request_.arithmetic = "double";
    request_.threads = 1;
    request_.record = false;
    request_.watch = false;
  }

  std::size_t dimension() const override { return size_; }
  MethodInfo claims() const override { return claims_with_walls(walls_, free_->claims()); }
  bool advance(State<double>& z, double h, std::int64_t steps) const override {
    return take(*simulation(z, h, request_), steps, z);
  }
  /// Computed in quad, which has more digits.
  bool advance(State<long double>& z, long double h, std::int64_t steps) const override {
    State<Quad> long_z(z.begin(), z.end());
    if (!advance(long_z, Quad(h), steps)) return false;
    std::transform(long_z.begin(), long_z.end(), z.begin(), [](const Quad& x) { return static_cast<long double>(x); });
    return true;
  }
  bool has_quad() const override { return true; }
  bool advance(State<Quad>& z, const Quad& h, std::int64_t steps) const override {
    return quad_steps(z, h, steps, in_quad(request_));
  }

  std::vector<std::vector<double>> jacobian(const State<double>& z, double h) const override {
    Tangents columns(z.size(), State<double>(z.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) columns[k][k] = 1;
    State<double> end = z;
    if (!advance_with_tangents(end, columns, h, 1)) return {};
    std::vector<std::vector<double>> rows(z.size(), std::vector<double>(z.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t k = 0; k < rows.size(); ++k) rows[i][k] = columns[k][i];
    }
    return rows;
  }

  /// A run from here finds the steps with bounces; the steps between them are taken together.
  bool advance_with_tangents(State<double>& z, Tangents& tangents, double h, std::int64_t steps) const override {
    const auto run = simulation(z, h, request_);
    std::vector<std::int64_t> with_bounce;
    run->on_bounce([&](const Bounce& bounce) {
      if (with_bounce.empty() || with_bounce.back() != bounce.step) with_bounce.push_back(bounce.step);
    });
    if (run->advance(steps) != Outcome::done) return false;
    std::int64_t done = 0;
    for (const std::int64_t next : with_bounce) {
      const std::int64_t free = next - 1 - done;
      if (free > 0 && !free_->advance_with_tangents(z, tangents, h, free)) return false;
      if (!bounce(z, tangents, h)) return false;
      done = next;
    }
    return done == steps || free_->advance_with_tangents(z, tangents, h, steps - done);
  }

  std::vector<double> energies(const State<double>& z, double h, int blocks, std::int64_t steps) const override {
    const auto run = simulation(z, h, watching());
    std::vector<double> all{run->energy().initial};
    for (int b = 0; b < blocks; ++b) {
      if (run->advance(steps) != Outcome::done) break;
      all.push_back(run->energy().final);
    }
    return all;
  }
  double energy_scale(const State<double>& z) const override { return simulation(z, 1.0, watching())->energy_scale(); }
  Effort cost(const State<double>& z, double h, std::int64_t steps) const override {
    const auto run = simulation(z, h, request_);
    (void)run->advance(steps);
    return run->effort();
  }

  /// The exact motion has located bounces, whatever the rule. It is computed by extrapolation, in parts so short that a
  /// coordinate turns at most once in each.
  State<Quad> flow(const State<Quad>& z, const Quad& t) const override {
    constexpr int parts = 32;
    Request request = in_quad(request_);
    request.method = {ExtrapolatedMidpoint::name, {{tolerance_option, "1e-31"}}};
    Walls located = walls_;
    located.rule = WallRule::event;
    request.walls = located;
    State<Quad> end = z;
    if (t != Quad(0) && !quad_steps(end, t / Quad(parts), parts, request)) {
      throw Error("the motion between the walls cannot be computed");
    }
    return end;
  }
  State<long double> flow(const State<long double>& z, long double t) const override {
    const State<Quad> end = flow(State<Quad>(z.begin(), z.end()), Quad(t));
    State<long double> shorter;
    for (const Quad& x : end) shorter.push_back(static_cast<long double>(x));
    return shorter;
  }

 private:
  Request watching() const {
    Request request = request_;
    request.watch = true;
    return request;
  }
  static Request in_quad(Request request) {
    request.arithmetic = "quad";
    return request;
  }
  std::unique_ptr<Simulation> simulation(const State<double>& z, double h, const Request& request) const {
    return simulate_erased<double>({problem_.in_double, part_of(z, 0, size_), part_of(z, size_, size_), h}, request);
  }
  static bool take(Simulation& run, std::int64_t steps, State<double>& z) {
    if (run.advance(steps) != Outcome::done) return false;
    Frame frame;
    run.look(frame);
    z = frame.q;
    z.insert(z.end(), frame.p.begin(), frame.p.end());
    return true;
  }
  /// A stored coordinate begins with its number, whatever else it holds.
  bool quad_steps(State<Quad>& z, const Quad& h, std::int64_t steps, const Request& request) const {
    const auto run =
        simulate_erased<Quad>({problem_.in_quad, part_of(z, 0, size_), part_of(z, size_, size_), h}, request);
    if (run->advance(steps) != Outcome::done) return false;
    const std::vector<std::byte> bits = run->bits();
    const std::size_t stride = bits.size() / z.size();
    for (std::size_t i = 0; i < z.size(); ++i) Reader(std::span(bits).subspan(i * stride))(z[i]);
    return true;
  }

  /// Takes one step that has bounces.
  bool bounce(State<double>& z, Tangents& tangents, double h) const {
    const auto run = simulation(z, h, request_);
    std::vector<Bounce> met;
    run->on_bounce([&](const Bounce& bounce) { met.push_back(bounce); });
    State<double> end = z;
    if (!take(*run, 1, end)) return false;
    if (met.empty()) return free_->advance_with_tangents(z, tangents, h, 1);  // no bounce here, because of rounding
    if (walls_.rule == WallRule::event) {
      if (!through(met, z, tangents, h)) return false;
    } else if (walls_.rule == WallRule::mirror) {
      if (!free_->advance_with_tangents(z, tangents, h, 1)) return false;
      for (const Bounce& at : met) {
        for (State<double>& tangent : tangents) {
          for (const std::size_t i : {at.coordinate, size_ + at.coordinate}) tangent[i] = -tangent[i];
        }
      }
    } else if (!reflect(met.back(), z, tangents)) {
      return false;
    }
    z = end;
    return true;
  }

  /// Takes the step from wall to wall. A neighbouring motion, displaced by the tangent vector, is dq_i further from the
  /// wall and hits it dtau later, dtau = -dq_i/(dPsi_tau/dtau)_i; its remaining time is shorter by dtau (the saltation
  /// matrix).
  bool through(const std::vector<Bounce>& met, State<double>& z, Tangents& tangents, double h) const {
    double used = 0;
    std::vector<double> later(tangents.size());
    for (const Bounce& at : met) {
      const auto rate = advance_part(z, tangents, at.time - used, h);  // the step begins at t = 0
      if (!rate) return false;
      used = at.time;
      const double speed = (*rate)[at.coordinate];
      for (std::size_t k = 0; k < tangents.size(); ++k) {
        const double further = -tangents[k][at.coordinate] / speed;
        if (!std::isfinite(further)) return false;  // a grazing hit has no derivative
        for (std::size_t i = 0; i < z.size(); ++i) tangents[k][i] += further * (*rate)[i];
        tangents[k][at.coordinate] = 0;
        later[k] += further;
      }
      if (!reflect(at, z, tangents)) return false;
    }
    const auto rate = advance_part(z, tangents, h - used, h);
    if (!rate) return false;
    for (std::size_t k = 0; k < tangents.size(); ++k) {
      for (std::size_t i = 0; i < z.size(); ++i) tangents[k][i] -= later[k] * (*rate)[i];
    }
    return true;
  }

  /// Advances by Psi_length with tangents. @return the derivative of the state by the length
  std::optional<State<double>> advance_part(State<double>& z, Tangents& tangents, double length, double h) const {
    if (length == 0) return field(z);
    std::optional<State<double>> rate = rate_of(z, length, h);
    if (rate && !free_->advance_with_tangents(z, tangents, length, 1)) return std::nullopt;
    return rate;
  }

  /// A difference quotient of two steps in quad. With a distance of 2^-37 h its error and its rounding are both some
  /// 2^-74, and no kernel has to be compiled for dual step sizes. Newton iterates to the rounding of quad, because a
  /// residual at the tolerance would be divided by the distance. h is the length of the whole step, since a part may be
  /// much shorter.
  std::optional<State<double>> rate_of(const State<double>& z, double length, double h) const {
    Request request = in_quad(request_);
    request.walls.reset();
    if (!free_->claims().explicit_step) {  // the first option of Newton is the tolerance
      const auto& options = find_method(request.method.name).family->options;
      auto option =
          std::find_if(options.begin(), options.end(), [](auto& each) { return each.name == tolerance_option; });
      for (; option != options.end(); ++option) request.method.options.erase(option->name);
    }
    const Quad apart = Quad(h) * Quad(0x1p-37);
    State<Quad> ahead(z.begin(), z.end());
    State<Quad> behind = ahead;
    if (!quad_steps(ahead, Quad(length) + apart, 1, request)) return std::nullopt;
    if (!quad_steps(behind, Quad(length) - apart, 1, request)) return std::nullopt;
    State<double> rate(z.size());
    for (std::size_t i = 0; i < z.size(); ++i) {
      rate[i] = static_cast<double>((ahead[i] - behind[i]) / (Quad(2) * apart));
    }
    return rate;
  }

  /// J grad H.
  State<double> field(const State<double>& z) const {
    const V q = part_of(z, 0, size_);
    const V p = part_of(z, size_, size_);
    V force = V(size_);
    V velocity = V(size_);
    const Functions<double>& h = *problem_.in_double.plain;
    if (h.has_parts()) {
      h.velocity(p, velocity);
      h.force(q, force);
    } else {
      h.gradient(q, p, force, velocity);
      for (double& x : force) x = -x;
    }
    State<double> all(velocity.begin(), velocity.end());
    all.insert(all.end(), force.begin(), force.end());
    return all;
  }

  /// Maps the state before a bounce to the state after it. The new momentum is the other root of H(q, p + lambda e_i) =
  /// H(q, p), with the derivative dp'_i = ((H_q - H'_q) dq + H_p dp - sum_(j != i) H'_p_j dp_j)/H'_p_i.
  bool reflect(const Bounce& at, State<double>& z, Tangents& tangents) const {
    const std::size_t turned = size_ + at.coordinate;
    const double before = z[turned];
    z = at.q;
    z.insert(z.end(), at.p.begin(), at.p.end());
    State<double> other = z;
    other[turned] = before;
    const State<double> f = field(other);
    const State<double> g = field(z);
    bool even = z[turned] == -before;  // true in most problems, and valid at rest, too
    for (std::size_t i = 0; i < z.size(); ++i) even = even && g[i] == (i == at.coordinate ? -f[i] : f[i]);
    for (State<double>& tangent : tangents) {
      if (even) {
        tangent[turned] = -tangent[turned];
        continue;
      }
      double sum = f[at.coordinate] * tangent[turned];
      for (std::size_t j = 0; j < size_; ++j) {
        sum += (g[size_ + j] - f[size_ + j]) * tangent[j];
        if (j != at.coordinate) sum += (f[j] - g[j]) * tangent[size_ + j];
      }
      tangent[turned] = sum / g[at.coordinate];
      if (!std::isfinite(tangent[turned])) return false;
    }
    return true;
  }

  ErasedProblem problem_;
  Request request_;
  Walls walls_;
  std::unique_ptr<StepMap> free_;  // without walls; with mirrors, for the H that continues beyond them
  std::size_t size_;
};

}  // namespace

std::unique_ptr<StepMap> step_map_with_walls(const ErasedProblem& problem, const Request& request, const Walls& walls,
                                             MakeStepMap make) {
  if (walls.hard()) return std::make_unique<WalledStepMap>(problem, request, walls, make);
  return make(problem_with_walls(problem, request, walls), request.method);
}

}  // namespace hamflow
