// Steps of cg(1) of few coordinates by two programs, around which Newton's decisions stand
// (numerics/newton_progress.hpp): one correction of the unknowns, and what a step leaves behind, the first guess of the
// next step included. Their bits are those of RecordedElement. A step that leaves their straight road is for the
// simulation itself.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hamflow/methods/implicit/element_programs.hpp"
#include "hamflow/numerics/newton_progress.hpp"
#include "hamflow/run/recorded_iteration.hpp"

namespace hamflow {

/// Where the numbers of a step stand: h, position, state and probe, the last three solutions (the latest first), the
/// unknowns, then what one correction leaves for the end of the step.
struct SegmentFrame {
  static constexpr std::size_t most_unknowns = 2;  // whose linear system is Cramer's
  std::size_t n = 0;                               // coordinates
  std::size_t m = 0;                               // unknowns of Newton
  std::size_t recorded = 0;                        // numbers in the archives of state and probe

  /// As TracedFrame knows them.
  IterationFrame carried() const { return {n, m, recorded}; }
  std::size_t memory() const { return carried().memory(); }
  std::size_t x() const { return memory() + 3 * m; }
  std::size_t from() const { return x() + m; }                  // the unknowns before the last correction
  std::size_t correction() const { return from() + m; }         // the last one
  std::size_t corrections() const { return correction() + m; }  // how many there were
  std::size_t size_of_correction() const { return corrections() + 1; }
  std::size_t total() const { return size_of_correction() + 1; }
  std::size_t noise() const { return total() + 1; }
  std::size_t hidden() const { return noise() + 1; }  // above 0: rounding hides the unknowns
  std::size_t sum() const { return hidden() + 1; }    // of the element's point, as its target and its matrix
  std::size_t target() const { return sum() + m; }
  std::size_t matrix() const { return target() + m; }
  std::size_t size() const { return matrix() + m * m; }
};

class SegmentLoop {
 public:
  /// @param of_correction the work of one correction
  SegmentLoop(const SegmentFrame& frame, const Program& correct, const Program& finish, const Effort& of_correction,
              int most_corrections)
      : frame_(frame),
        correct_(make_step_loop(correct)),
        finish_(make_step_loop(finish)),
        of_correction_(of_correction),
        most_corrections_(most_corrections),
        before_(frame.from()) {}

  /// Takes steps from a frame with a first guess, until a step is for the simulation.
  /// @return how many were taken; the frame is behind them   @param effort to which their work is added
  std::int64_t run(std::span<double> numbers, std::int64_t steps, Effort& effort) {
    std::int64_t taken = 0;
    for (; taken < steps; ++taken) {
      std::copy_n(numbers.begin(), before_.size(), before_.begin());
      const int corrections = solved(numbers);
      if (corrections == 0 || !finish_->run(numbers, 1)) {
        std::copy(before_.begin(), before_.end(), numbers.begin());
        break;
      }
      effort.force += corrections * of_correction_.force;
      effort.gradient += corrections * of_correction_.gradient;
      effort.hessian += corrections * of_correction_.hessian;
      effort.linear_solves += corrections;
      effort.solves_min = effort.steps == 0 || corrections < effort.solves_min ? corrections : effort.solves_min;
      effort.solves_max = corrections > effort.solves_max ? corrections : effort.solves_max;
      ++effort.steps;
    }
    return taken;
  }

 private:
  /// @return after how many corrections; 0: not as it mostly goes
  int solved(std::span<double> numbers) const {
    numbers[frame_.corrections()] = 0;
    NewtonProgress<double> progress(Convergence::quadratic);
    for (int k = 1; k <= most_corrections_; ++k) {
      if (!correct_->run(numbers, 1)) return 0;
      const double noise = numbers[frame_.noise()];
      const NewtonDecision decision =
          progress.judge(numbers[frame_.size_of_correction()], numbers[frame_.total()], noise);
      if (decision == NewtonDecision::go_on) continue;
      const bool is_plain = decision == NewtonDecision::settled && !progress.began_far_away(noise) &&
                            !(numbers[frame_.hidden()] > 0) && (k > 1 || frame_.m == frame_.n);
      return is_plain ? k : 0;
    }
    return 0;
  }

  SegmentFrame frame_;
  std::shared_ptr<const StepLoop> correct_;
  std::shared_ptr<const StepLoop> finish_;
  Effort of_correction_;
  int most_corrections_;
  std::vector<double> before_;
};

/// Records the programs of a segment loop.
/// @tparam natural H = p^T M^-1 p/2 + V(q)   @tparam P the traced problem of the element   @tparam Watched that of the
/// probe
template <bool natural, class P, class Watched>
class SegmentRecorder {
  using Number = Trace<double>;
  using V = Vector<Number, dynamic>;
  using Element = typename detail::ElementOnFrame<P, natural>::Element;
  using Point = typename Element::Point;
  using Frame = detail::TracedFrame<Watched, Compensated<Number>>;

 public:
  SegmentRecorder(const P& problem, const Watched& watched, const CgOptions& options, const SegmentFrame& frame)
      : problem_(problem), watched_(watched), setup_(problem, options), frame_(frame) {}

  /// @return nothing where they are no straight lines, or too long
  std::optional<SegmentLoop> loop(std::span<const double> numbers, const IterationTime& time) const {
    try {
      Effort of_correction;
      const Program correct = correction(numbers, time, of_correction);
      const std::optional<Program> finish = end_of_step(numbers, time);
      if (!finish) return std::nullopt;
      return SegmentLoop(frame_, correct, *finish, of_correction, setup_.newton().max_iterations);
    } catch (const CannotRecord&) {
      return std::nullopt;
    }
  }

 private:
  Program correction(std::span<const double> numbers, const IterationTime& time, Effort& effort) const {
    Frame f(watched_, frame_.carried(), numbers, time.start);
    const V q0 = f.z.positions();
    const V p0 = f.z.momenta();
    const Element e(setup_, problem_, f.numbers[IterationFrame::h], q0, p0, effort);
    const V x = f.read(frame_.x(), frame_.m);
    Point at;
    e.evaluate(x, at);
    Number& corrections = f.numbers[frame_.corrections()];
    if constexpr (!natural) {  // the last correction is mostly the second one, or a later one
      const V sharp = e.lost(x, at);
      for (std::size_t i = 0; i < x.size(); ++i) at.residual[i] = choose(corrections, sharp[i], at.residual[i]);
    }
    const V c = solved(e.tangent(at), at.residual);
    const auto measured = measure(e, x, at, c);
    f.numbers[frame_.size_of_correction()] = measured.size;
    f.numbers[frame_.noise()] = measured.noise;
    Number total = measured.size;
    for (const Number& each : c) total += abs(each);
    f.numbers[frame_.total()] = total;
    f.numbers[frame_.hidden()] = hidden(e, x, at, c);
    f.put(x, frame_.from());
    f.put(c, frame_.correction());
    for (std::size_t i = 0; i < x.size(); ++i) f.numbers[frame_.x() + i] = x[i] + c[i];
    corrections += Number(1);
    f.put(at.sum, frame_.sum());
    f.put(at.target, frame_.target());
    const auto& matrix = matrix_of(at);
    for (std::size_t i = 0; i < frame_.m; ++i) {
      for (std::size_t j = 0; j < frame_.m; ++j) f.numbers[frame_.matrix() + i * frame_.m + j] = matrix[i][j];
    }
    return program_of(f.recorder.finish(f.numbers));
  }

  std::optional<Program> end_of_step(std::span<const double> numbers, const IterationTime& time) const {
    Frame f(watched_, frame_.carried(), numbers, time.start);
    const V q0 = f.z.positions();
    const V p0 = f.z.momenta();
    const Number h = f.numbers[IterationFrame::h];
    Effort unused;
    const Element e(setup_, problem_, h, q0, p0, unused);
    V x = f.read(frame_.from(), frame_.m);
    V c = f.read(frame_.correction(), frame_.m);
    const Point at = point(f, x);
    if constexpr (natural) {  // as NaturalElement::made_up_for, without its branch
      const auto k = e.tangent(at);
      const V lost = e.lost(x, at);
      const V solution = solved(k, lost);
      Number from_identity(0);
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t j = 0; j < x.size(); ++j) from_identity += abs(k[i][j] - Number(i == j ? 1 : 0));
      }
      const Number is_near = Number(0.03125) - from_identity;
      for (std::size_t i = 0; i < x.size(); ++i) c[i] += choose(is_near, lost[i], solution[i]);
    }
    const Increment<Number, dynamic> taken = e.corrected(x, at, c);
    for (std::size_t i = 0; i < frame_.n; ++i) {
      f.z.arithmetic.position.add_keeping(f.z.q[i], taken.q[i]);
      f.z.arithmetic.momentum.add_keeping(f.z.p[i], taken.p[i]);
    }
    Number& position = f.numbers[IterationFrame::position];
    position += Number(time.direction);
    const V q = f.z.positions();
    const V p = f.z.momenta();
    if (!f.probe.look(watched_, q, p, Number(time.start) + position * (Number(time.direction) * h)))
      return std::nullopt;
    f.put_carried();
    const V latest = e.memory(x, taken);
    const V second = f.read(frame_.memory(), frame_.m);
    const V third = f.read(frame_.memory() + frame_.m, frame_.m);
    f.put(latest, frame_.memory());
    f.put(second, frame_.memory() + frame_.m);
    f.put(third, frame_.memory() + 2 * frame_.m);
    Extrapolation<V> memory;
    for (const V* each : {&third, &second, &latest}) memory.remember(*each);
    f.put(Element(setup_, problem_, h, q, p, unused).started(memory.predicted()), frame_.x());
    return program_of(f.recorder.finish(f.numbers));
  }

  V solved(const Matrix<Number, dynamic>& k, const V& b) const {
    V x(frame_.m);
    if (frame_.m == 1) {
      x[0] = b[0] / k[0][0];
      return x;
    }
    Matrix<Number, 2> matrix{};
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) matrix[i][j] = k[i][j];
    }
    const Vector<Number, 2> solution = hamflow::solve(matrix, Vector<Number, 2>{b[0], b[1]});
    x[0] = solution[0];
    x[1] = solution[1];
    return x;
  }
  /// As the element measures it, without branches.
  static Correction<Number> measure(const Element& e, const V& x, const Point& at, const V& c) {
    if constexpr (natural) {
      return e.measure(x, at, c);
    } else {
      Number distance(0);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const Number size = abs(c[i]);
        const Number unit = Epsilon<Number>{} * Number(at.noise[i] + abs(x[i]));
        const Number own = Epsilon<Number>{} * size;
        const Number known = choose(Number(unit - Epsilon<Number>{} * own), unit, own);
        const Number here = size / larger(known, Number(std::numeric_limits<double>::min()));
        distance = larger(distance, here);
      }
      return {distance, Number(1)};
    }
  }
  /// Above 0 where hidden_by_rounding() is true.
  static Number hidden(const Element& e, const V& x, const Point& at, const V& c) {
    V next = x;
    for (std::size_t i = 0; i < x.size(); ++i) next[i] += c[i];
    Number unknown = max_norm(next);
    if constexpr (natural) unknown = larger(e.flight(), unknown);
    return Epsilon<Number>{} * max_norm(at.target) - unknown / (1 << 20);
  }
  static const auto& matrix_of(const Point& at) {
    if constexpr (natural) {
      return at.stiffness;
    } else {
      return at.tangent;
    }
  }
  /// What correction() has left.
  Point point(const Frame& f, const V& x) const {
    Point at;
    at.sum = f.read(frame_.sum(), frame_.m);
    at.target = f.read(frame_.target(), frame_.m);
    at.residual = at.target;
    for (std::size_t i = 0; i < x.size(); ++i) at.residual[i] = at.target[i] - x[i];
    Matrix<Number, dynamic> matrix(frame_.m);
    for (std::size_t i = 0; i < frame_.m; ++i) {
      for (std::size_t j = 0; j < frame_.m; ++j) matrix[i][j] = f.numbers[frame_.matrix() + i * frame_.m + j];
    }
    if constexpr (natural) {
      at.stiffness = matrix;
    } else {
      at.tangent = matrix;
    }
    return at;
  }

  P problem_;
  Watched watched_;
  typename Element::Setup setup_;
  SegmentFrame frame_;
};

}  // namespace hamflow
