#include "recorded_tangents.hpp"

#include <algorithm>
#include <memory>
#include <mutex>

#include "numerics/program_tangent.hpp"

namespace hamflow {

std::vector<std::size_t> moving_values(const Program& start, std::size_t state) {
  std::vector<bool> results(start.operations.size());
  const auto moves = [&](const Operand& x) {
    if (x.kind == Operand::Kind::carried) return x.index < state;
    return x.kind == Operand::Kind::result && results[x.index];
  };
  for (std::size_t i = 0; i < start.operations.size(); ++i) {
    const auto& [kind, a, b, c] = start.operations[i];
    results[i] = moves(a) || moves(b) || moves(c);
  }
  std::vector<std::size_t> moving;
  for (std::size_t k = 0; k < start.values(); ++k) {
    if (k < state || moves(start.outputs[k])) moving.push_back(k);
  }
  return moving;
}

std::optional<Program> with_moving(const Program& program, std::span<const std::size_t> moving, std::size_t vectors) {
  const auto flags = std::make_unique<bool[]>(program.values());
  for (const std::size_t k : moving) flags[k] = true;
  return with_tangents(program, {flags.get(), program.values()}, vectors);
}

namespace {
/// The loops for one step size and number of vectors: one for the first step from a state, one for the steps after it.
struct Loops {
  double h = 0;
  std::size_t vectors = 0;
  std::size_t values = 0;
  std::vector<std::size_t> moving;  // the values whose slopes are carried, the state first
  std::unique_ptr<const StepLoop> start;
  std::unique_ptr<const StepLoop> steady;  // null: the steps cannot be recorded or differentiated
};

class RecordedTangents {
 public:
  explicit RecordedTangents(TangentRecorder recorder) : recorder_(std::move(recorder)) {}

  bool advance(State<double>& z, std::vector<State<double>>& tangents, double h, std::int64_t steps) {
    if (steps < 1 || tangents.empty()) return false;
    const std::shared_ptr<const Loops> loops = loops_for(z, h, tangents.size());
    if (!loops->steady) return false;
    const std::size_t moving = loops->moving.size();
    std::vector<double> carried(loops->values + loops->vectors * moving);
    std::copy(z.begin(), z.end(), carried.begin());
    for (std::size_t j = 0; j < tangents.size(); ++j) {
      std::copy(tangents[j].begin(), tangents[j].end(), slopes(carried, *loops, j));
    }
    if (!loops->start->run(carried, 1) || !loops->steady->run(carried, steps - 1)) return false;
    std::copy_n(carried.begin(), z.size(), z.begin());
    for (std::size_t j = 0; j < tangents.size(); ++j) {
      std::copy_n(slopes(carried, *loops, j), z.size(), tangents[j].begin());
    }
    return true;
  }

 private:
  static std::vector<double>::iterator slopes(std::vector<double>& carried, const Loops& loops, std::size_t j) {
    return carried.begin() + static_cast<std::ptrdiff_t>(loops.values + j * loops.moving.size());
  }

  std::shared_ptr<const Loops> loops_for(const State<double>& z, double h, std::size_t vectors) {
    const std::lock_guard lock(mutex_);
    for (const auto& loops : made_) {
      if (loops->h == h && loops->vectors == vectors) return loops;
    }
    made_.push_back(make(z, h, vectors));
    return made_.back();
  }

  std::shared_ptr<const Loops> make(const State<double>& z, double h, std::size_t vectors) const {
    auto loops = std::make_shared<Loops>();
    loops->h = h;
    loops->vectors = vectors;
    const std::size_t n = z.size() / 2;
    auto q = zeros<double, dynamic>(n);
    auto p = zeros<double, dynamic>(n);
    std::copy_n(z.begin(), n, q.begin());
    std::copy_n(z.begin() + static_cast<std::ptrdiff_t>(n), n, p.begin());
    const auto start = recorder_(q, p, h, RecordedAt::start);
    const auto steady = recorder_(q, p, h, RecordedAt::steady);
    if (!start || !steady || start->program.values() != steady->program.values()) return loops;
    loops->values = start->program.values();
    loops->moving = moving_values(start->program, z.size());
    const auto with_start = with_moving(start->program, loops->moving, vectors);
    const auto with_steady = with_moving(steady->program, loops->moving, vectors);
    if (!with_start || !with_steady) return loops;
    loops->start = make_step_loop(*with_start);
    loops->steady = make_step_loop(*with_steady);
    return loops;
  }

  TangentRecorder recorder_;
  std::mutex mutex_;
  std::vector<std::shared_ptr<const Loops>> made_;
};
}  // namespace

TangentSteps recorded_tangents(TangentRecorder recorder) {
  auto shared = std::make_shared<RecordedTangents>(std::move(recorder));
  return [shared](State<double>& z, std::vector<State<double>>& tangents, double h, std::int64_t steps) {
    return shared->advance(z, tangents, h, steps);
  };
}

}  // namespace hamflow
