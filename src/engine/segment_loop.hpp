// Steps of cg(1) for few coordinates by two programs: one evaluates the equations at the present unknowns, the other
// completes a step and computes the initial guess of the next one. Newton's method
// (detail/numerics/newton_progress.hpp) decides between them. The bits are those of RecordedElement. All other steps
// are left to the simulation.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "element_programs.hpp"
#include "erased.hpp"
#include "hamflow/detail/numerics/newton_progress.hpp"
#include "recorded_iteration.hpp"

namespace hamflow {

/// The places of the numbers of a step: h, position, state and probe, the last three solutions (latest first), the
/// unknowns and their last correction, then the values of the equations.
struct SegmentFrame {
  std::size_t n = 0;         // coordinates
  std::size_t m = 0;         // unknowns of Newton, n or 2 n
  std::size_t recorded = 0;  // numbers in the archives of state and probe

  bool is_natural() const { return m == n; }
  /// The frame as TracedFrame uses it.
  IterationFrame carried() const { return {n, m, recorded}; }
  std::size_t memory() const { return carried().memory(); }
  std::size_t x() const { return memory() + 3 * m; }
  std::size_t correction() const { return x() + m; }
  std::size_t residual() const { return correction() + m; }
  std::size_t lost() const { return residual() + m; }  // rounding error of the residual
  std::size_t tangent() const { return lost() + m; }   // the Jacobian, row by row
  std::size_t free_displacement() const { return tangent() + m * m; }
  std::size_t sum() const { return free_displacement() + 1; }
  std::size_t target() const { return sum() + m; }
  std::size_t noise() const { return target() + m; }      // for a general element
  std::size_t stiffness() const { return target() + m; }  // for a natural element
  // With quadrature = "auto": H at the state, then two numbers of the last step beyond rounding: the error of the
  // quadrature of the work, and the change of H.
  std::size_t energy() const { return target() + m + m * m; }
  std::size_t missed() const { return energy() + 1; }
  std::size_t change() const { return missed() + 1; }
  std::size_t size() const { return change() + 1; }
};

class SegmentLoop {
  using P = Erased<double, Capability::smooth>;

 public:
  /// @param work the work of one evaluation of the equations   @param work_of_finish the work of testing the points
  SegmentLoop(const SegmentFrame& frame, const Program& first_guess, const Program& equations, const Program& finish,
              const Effort& work, const Effort& work_of_finish, int most_corrections)
      : frame_(frame),
        first_guess_(make_step_loop(first_guess)),
        equations_(make_step_loop(equations)),
        finish_(make_step_loop(finish)),
        work_(work),
        work_of_finish_(work_of_finish),
        most_corrections_(most_corrections),
        before_(frame.correction()) {}

  /// Computes the initial guess of a step in a frame. @return whether it is valid
  bool begin(std::span<double> numbers) const { return first_guess_->run(numbers, 1); }
  /// Takes steps from a frame with an initial guess, until a step must be left to the simulation.
  /// @return the number of steps taken; the frame is the one after them   @param effort their work is added to it
  std::int64_t run(std::span<double> numbers, std::int64_t steps, Effort& effort) {
    std::int64_t taken = 0;
    for (; taken < steps; ++taken) {
      std::copy_n(numbers.begin(), before_.size(), before_.begin());
      const int corrections = solved(numbers);
      if (corrections == 0 || !finish_->run(numbers, 1) || numbers[frame_.missed()] > 0 ||
          numbers[frame_.change()] > 0) {
        std::copy(before_.begin(), before_.end(), numbers.begin());
        break;
      }
      effort.force += corrections * work_.force + work_of_finish_.force;
      effort.gradient += corrections * work_.gradient + work_of_finish_.gradient;
      effort.hessian += corrections * work_.hessian + work_of_finish_.hessian;
      effort.linear_solves += corrections;
      effort.solves_min = effort.steps == 0 || corrections < effort.solves_min ? corrections : effort.solves_min;
      effort.solves_max = corrections > effort.solves_max ? corrections : effort.solves_max;
      ++effort.steps;
    }
    return taken;
  }

 private:
  /// Newton<RecordedElement>::iterate() for ordinary steps. @return the number of corrections; 0 for other steps
  int solved(std::span<double> numbers) const {
    NewtonProgress<double> progress(Convergence::quadratic);
    for (int k = 1; k <= most_corrections_; ++k) {
      if (!equations_->run(numbers, 1)) return 0;
      const SmallVector x = read(numbers, frame_.x());
      const SmallRows tangent = tangent_at(numbers);
      SmallVector correction = solve(tangent, residual_at(numbers, k > 1));
      const Correction<double> c = measure(numbers, x, correction);
      double total = c.size;
      for (std::size_t i = 0; i < x.size(); ++i) total += std::abs(correction[i]);
      const NewtonDecision decision = progress.judge(c.size, total, c.noise);
      if (decision == NewtonDecision::go_on) {
        for (std::size_t i = 0; i < x.size(); ++i) numbers[frame_.x() + i] = x[i] + correction[i];
        continue;
      }
      if (decision != NewtonDecision::settled || progress.began_far_away(c.noise) ||
          is_hidden(numbers, x, correction)) {
        return 0;
      }
      if (k == 1 && removes_residual_rounding()) correction = solve(tangent, residual_at(numbers, true));
      if (!removes_residual_rounding()) {
        const SmallVector more = NaturalElement<P, double>::made_up_for(tangent, read(numbers, frame_.lost()));
        for (std::size_t i = 0; i < x.size(); ++i) correction[i] += more[i];
      }
      for (std::size_t i = 0; i < x.size(); ++i) numbers[frame_.correction() + i] = correction[i];
      return k;
    }
    return 0;
  }

  /// Whether the rounding of the residual is removed before a correction is solved; in the plane this is done at the
  /// end.
  bool removes_residual_rounding() const { return !(frame_.is_natural() && frame_.n <= 2); }
  SmallVector residual_at(std::span<const double> numbers, bool sharp) const {
    SmallVector r = read(numbers, frame_.residual());
    if (!sharp || !removes_residual_rounding()) return r;
    for (std::size_t i = 0; i < frame_.m; ++i) {
      const double lost = numbers[frame_.lost() + i];
      r[i] = frame_.is_natural() ? r[i] + lost : lost;
    }
    return r;
  }
  SmallRows tangent_at(std::span<const double> numbers) const {
    SmallRows k;
    k.count = frame_.m;
    const double* from = &numbers[frame_.tangent()];
    for (std::size_t i = 0; i < frame_.m; ++i) {
      for (std::size_t j = 0; j < frame_.m; ++j) k[i][j] = *from++;
    }
    return k;
  }
  Correction<double> measure(std::span<const double> numbers, const SmallVector& x,
                             const SmallVector& correction) const {
    if (frame_.is_natural()) {
      return NaturalElement<P, double>::measured(numbers[frame_.free_displacement()], read(numbers, frame_.target()), x,
                                                 correction);
    }
    return GeneralElement<P, double>::measured(read(numbers, frame_.noise()), x, correction);
  }
  bool is_hidden(std::span<const double> numbers, const SmallVector& x, const SmallVector& correction) const {
    const SmallVector target = read(numbers, frame_.target());
    const double terms = frame_.is_natural() ? NaturalElement<P, double>::hidden_terms_of(
                                                   numbers[frame_.free_displacement()], target, x, correction)
                                             : GeneralElement<P, double>::hidden_terms_of(target, x, correction);
    return terms > 0;
  }
  SmallVector read(std::span<const double> numbers, std::size_t from) const {
    SmallVector x;
    x.count = frame_.m;
    for (std::size_t i = 0; i < frame_.m; ++i) x[i] = numbers[from + i];
    return x;
  }

  SegmentFrame frame_;
  std::shared_ptr<const StepLoop> first_guess_;
  std::shared_ptr<const StepLoop> equations_;
  std::shared_ptr<const StepLoop> finish_;
  Effort work_;
  Effort work_of_finish_;
  int most_corrections_;
  std::vector<double> before_;
};

/// Records the programs of a segment loop.
/// @tparam natural whether H = p^T M^-1 p/2 + V(q)   @tparam P the traced problem of the element
/// @tparam Watched the traced problem of the probe
template <bool natural, class P, class Watched>
class SegmentRecorder {
  using Number = Trace<double>;
  using V = Vector<Number, dynamic>;
  using Element = typename detail::ElementOnFrame<P, natural>::Element;
  using Point = typename Element::Point;
  using Frame = detail::TracedFrame<Watched, Compensated<Number>>;

 public:
  /// @param options with the present number of points   @param judges whether every step tests the points
  SegmentRecorder(const P& problem, const Watched& watched, const CgOptions& options, const SegmentFrame& frame,
                  bool judges)
      : problem_(problem), watched_(watched), setup_(problem, options), frame_(frame), judges_(judges) {}

  /// @return nullopt if they branch or are too long
  std::optional<SegmentLoop> loop(std::span<const double> numbers, const IterationTime& time) const {
    try {
      Effort work, work_of_finish;
      const Program guess = first_guess(numbers, time);
      const Program at_x = equations(numbers, time, work);
      const std::optional<Program> finish = end_of_step(numbers, time, work_of_finish);
      if (!finish) return std::nullopt;
      return SegmentLoop(frame_, guess, at_x, *finish, work, work_of_finish, setup_.newton().max_iterations);
    } catch (const CannotRecord&) {
      return std::nullopt;
    }
  }

 private:
  Program first_guess(std::span<const double> numbers, const IterationTime& time) const {
    Frame f(watched_, frame_.carried(), numbers, time.start);
    const V q0 = f.z.positions();
    const V p0 = f.z.momenta();
    Effort unused;
    Extrapolation<V> memory;
    for (std::size_t back = 3; back-- > 0;) memory.remember(f.read(frame_.memory() + back * frame_.m, frame_.m));
    const Element e(setup_, problem_, f.numbers[IterationFrame::h], q0, p0, unused);
    f.put(e.started(memory.predicted()), frame_.x());
    return program_of(f.recorder.finish(f.numbers));
  }
  Program equations(std::span<const double> numbers, const IterationTime& time, Effort& work) const {
    Frame f(watched_, frame_.carried(), numbers, time.start);
    const V q0 = f.z.positions();
    const V p0 = f.z.momenta();
    const Element e(setup_, problem_, f.numbers[IterationFrame::h], q0, p0, work);
    const V x = f.read(frame_.x(), frame_.m);
    Point at;
    e.evaluate(x, at);
    f.put(at.residual, frame_.residual());
    f.put(e.lost(x, at), frame_.lost());
    put(e.tangent(at), f, frame_.tangent());
    f.numbers[frame_.free_displacement()] = e.free_displacement();
    f.put(at.sum, frame_.sum());
    f.put(at.target, frame_.target());
    if constexpr (natural) {
      put(at.stiffness, f, frame_.stiffness());
    } else {
      f.put(at.noise, frame_.noise());
    }
    return program_of(f.recorder.finish(f.numbers));
  }

  std::optional<Program> end_of_step(std::span<const double> numbers, const IterationTime& time, Effort& work) const {
    Frame f(watched_, frame_.carried(), numbers, time.start);
    const V q0 = f.z.positions();
    const V p0 = f.z.momenta();
    const Number h = f.numbers[IterationFrame::h];
    Effort unused;
    V x = f.read(frame_.x(), frame_.m);
    const Element e(setup_, problem_, h, q0, p0, work);
    const Increment<Number, dynamic> taken = e.corrected(x, point(f), f.read(frame_.correction(), frame_.m));
    if (judges_) f.numbers[frame_.missed()] = abs(e.finer_work(taken).gain) - e.rounding_of_work(taken);
    for (std::size_t i = 0; i < frame_.n; ++i) {
      f.z.arithmetic.position.add_with_exact_low(f.z.q[i], taken.q[i]);
      f.z.arithmetic.momentum.add_with_exact_low(f.z.p[i], taken.p[i]);
    }
    Number& position = f.numbers[IterationFrame::position];
    position += Number(time.direction);
    const V q = f.z.positions();
    const V p = f.z.momenta();
    const Number t = Number(time.start) + position * (Number(time.direction) * h);
    if (!f.probe.look(watched_, q, p, t)) return std::nullopt;
    if (judges_) {
      const Number before = f.numbers[frame_.energy()];
      const Number behind = hamflow::energy(watched_, q, p);
      f.numbers[frame_.energy()] = behind;
      f.numbers[frame_.change()] = abs(behind - before) - detail::explained_change(before, h, q0, p0, taken.q, taken.p);
    }
    f.put_carried();
    Extrapolation<V> memory;
    for (std::size_t back = 2; back > 0; --back) {
      const V earlier = f.read(frame_.memory() + (back - 1) * frame_.m, frame_.m);
      memory.remember(earlier);
      f.put(earlier, frame_.memory() + back * frame_.m);
    }
    const Element next(setup_, problem_, h, q, p, unused);
    const V latest = next.memory(x, taken);
    memory.remember(latest);
    f.put(latest, frame_.memory());
    f.put(next.started(memory.predicted()), frame_.x());
    return program_of(f.recorder.finish(f.numbers));
  }

  void put(const Matrix<Number, dynamic>& from, Frame& f, std::size_t to) const {
    for (std::size_t i = 0; i < frame_.m; ++i) {
      for (std::size_t j = 0; j < frame_.m; ++j) f.numbers[to + i * frame_.m + j] = from[i][j];
    }
  }
  Matrix<Number, dynamic> read_matrix(const Frame& f, std::size_t from) const {
    Matrix<Number, dynamic> matrix(frame_.m);
    for (std::size_t i = 0; i < frame_.m; ++i) {
      for (std::size_t j = 0; j < frame_.m; ++j) matrix[i][j] = f.numbers[from + i * frame_.m + j];
    }
    return matrix;
  }
  /// The results of equations() that the end of a step needs.
  Point point(const Frame& f) const {
    Point at;
    at.sum = f.read(frame_.sum(), frame_.m);
    at.target = f.read(frame_.target(), frame_.m);
    at.residual = f.read(frame_.residual(), frame_.m);
    if constexpr (natural) {
      at.stiffness = read_matrix(f, frame_.stiffness());
    } else {
      at.tangent = read_matrix(f, frame_.tangent());
    }
    return at;
  }

  P problem_;
  Watched watched_;
  typename Element::Setup setup_;
  SegmentFrame frame_;
  bool judges_;
};

}  // namespace hamflow
