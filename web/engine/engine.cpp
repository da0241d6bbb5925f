// The functions that the page calls: a scenario as text in, numbers out. Texts are JSON; rows of numbers stay in
// memory, where the page reads them. A function that fails returns {"errors": [...]} with the reader's own messages.
#include <emscripten.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "answers.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/run/section.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"
#include "map.hpp"
#include "starts.hpp"

namespace hamflow {
namespace {

/// Calls a function for the state after every n-th step, and for the state in which it begins.
class EveryStep final : public Observer {
 public:
  explicit EveryStep(std::function<void(const Frame&)> look) : look_(std::move(look)) {}
  void restart(std::int64_t every, std::int64_t from) {
    every_ = every;
    next_ = from + every;
  }
  std::int64_t next_due(std::int64_t step) const override { return std::max(step, next_); }
  Verdict observe(const Frame& frame) override {
    if (frame.step < next_) return Verdict::go_on;
    next_ = frame.step + every_;
    look_(frame);
    return Verdict::go_on;
  }

 private:
  std::function<void(const Frame&)> look_;
  std::int64_t every_ = 1;
  std::int64_t next_ = 0;
};

/// One motion of the page.
class Motion {
 public:
  explicit Motion(Scenario scenario)
      : scenario_(std::move(scenario)),
        simulation_(make_simulation(scenario_.request)),
        blocks_(energy_for_blocks(scenario_.request, *scenario_.problem, scenario_.start_q.size())),
        rows_of_steps_([this](const Frame& frame) { append(frame); }),
        start_bits_(simulation_->bits()) {
    simulation_->look(frame_);
    start_ = frame_;
    if (scenario_.section)
      section_ = std::make_unique<SectionFinder>(*simulation_, *scenario_.section,
                                                 [this](const SectionPoint& point) { append_point(point); });
    show({});
  }

  /// The columns of every row: t, all q, all p, H - H(0), then these expressions.
  /// @throws Error with the column of a syntax error
  void show(const std::vector<std::string>& expressions) {
    std::vector<StateExpression> read;
    for (const std::string& text : expressions) {
      read.emplace_back(text, *scenario_.problem, scenario_.request.parameters, scenario_.start_q.size());
    }
    expressions_ = std::move(read);
    rows_.clear();
    append(frame_);
  }

  /// Takes at most `steps` steps, and adds a row every `every` steps.
  void advance(std::int64_t steps, std::int64_t every) {
    rows_.clear();
    points_.clear();
    std::vector<Observer*> observers{&rows_of_steps_};
    rows_of_steps_.restart(every, simulation_->step());
    if (!reversed_) observers.push_back(&blocks_);
    if (section_) observers.push_back(section_.get());
    if (!is_failure(outcome_)) outcome_ = run(*simulation_, simulation_->step() + steps, observers);
    simulation_->look(frame_);
  }

  /// Negates the momenta, so that the motion runs back; a second time, and it is compared with its start.
  void reverse() {
    simulation_->negate_momenta();
    simulation_->look(frame_);
    reversed_ = true;
    outcome_ = Outcome::done;
  }

  Json facts() const {
    const StateNames names = state_names(*scenario_.problem, scenario_.request.parameters, scenario_.start_q.size());
    Json walls = Json::array();
    if (scenario_.request.walls) {
      for (const auto& each : scenario_.request.walls->intervals) {
        const auto number = [](const std::string& text) {
          return text.empty() ? Json() : Json(evaluate_number<double>(text));
        };
        walls.push_back({{"coordinate", each.index}, {"min", number(each.min)}, {"max", number(each.max)}});
      }
    }
    Json invariants = Json::array();
    for (const InvariantInfo& each : scenario_.problem->info.invariants) {
      invariants.push_back({{"name", each.name}, {"meaning", each.meaning}});
    }
    Json particles;
    if (scenario_.problem->particles) {
      const ParticleFacts found = scenario_.problem->particles(scenario_.request.parameters);
      particles = {
          {"space", found.space}, {"edges", found.edges}, {"radius", found.radius}, {"repulsion", found.repulsion}};
    }
    const MethodInfo method = describe(scenario_.request.method);
    return {{"problem", scenario_.problem->info.name},
            {"formula", scenario_.problem->info.formula},
            {"angles", scenario_.problem->info.angles},
            {"method", method.name},
            {"arithmetic", scenario_.request.arithmetic},
            {"dt", scenario_.dt},
            {"steps", scenario_.steps},
            {"map", scenario_.map},
            {"q", names.q},
            {"p", names.p},
            {"invariants", invariants},
            {"walls", walls},
            {"particles", particles},
            {"section", section_facts()},
            {"observables", observables()},
            {"settings", settings()},
            {"notes", scenario_.notes}};
  }

  Json state() const {
    const Excursion energy = simulation_->energy();
    Json invariants = Json::array();
    for (const InvariantExcursion& each : simulation_->invariants()) {
      invariants.push_back({{"initial", each.initial}, {"final", each.final}, {"max_error", each.max_error}});
    }
    Json walls = Json::array();
    for (const WallCount& each : simulation_->wall_counts()) {
      walls.push_back({{"coordinate", each.coordinate}, {"side", each.side}, {"bounces", each.bounces}});
    }
    const Effort effort = simulation_->effort();
    return {{"step", frame_.step},
            {"t", frame_.time},
            {"final", {{"q", frame_.q}, {"p", frame_.p}}},
            {"energy",
             {{"initial", energy.initial},
              {"final", energy.final},
              {"max_error", energy.max_error},
              {"scale", energy.scale()}}},
            {"invariants", invariants},
            {"walls", walls},
            {"evaluations", effort.force + effort.gradient + effort.hessian},
            {"outcome", name(outcome_)},
            {"failed", is_failure(outcome_)},
            {"message", is_failure(outcome_) ? failure() : ""}};
  }

  Json reversal() const {
    const std::vector<std::byte> bits = simulation_->bits();
    std::int64_t equal = 0;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      equal += 8 - std::popcount(static_cast<unsigned>(bits[i] ^ start_bits_[i]));
    }
    double distance = 0;
    for (std::size_t i = 0; i < frame_.q.size(); ++i) {
      distance = std::max({distance, std::abs(frame_.q[i] - start_.q[i]), std::abs(frame_.p[i] - start_.p[i])});
    }
    return {{"bits", 8 * static_cast<std::int64_t>(bits.size())}, {"equal", equal}, {"distance", distance}};
  }

  Json certificate() {
    const RunCertificate found =
        certify(scenario_.request, *scenario_.problem, simulation_, blocks_, simulation_->step());
    Json maps = Json::array();
    for (const MomentumMap& each : found.momentum_maps) {
      const std::optional<bool> conserved = each.conserved();
      maps.push_back({{"name", each.name},
                      {"max_error", each.max_error.value},
                      {"conserved", conserved ? Json(*conserved) : Json()}});
    }
    Json reversal;
    if (found.reversal)
      reversal = {{"proves", std::string(name(found.reversal->proves))}, {"reason", found.reversal->reason}};
    return {{"drift", found.drift.drift ? std::string(name(*found.drift.drift)) : "undecided"},
            {"reason", found.drift.reason},
            {"level", found.energy_level.value},
            {"invariants", maps},
            {"reversal", reversal}};
  }

  std::size_t width() const { return 2 + 2 * start_.q.size() + expressions_.size(); }
  const std::vector<double>& rows() const { return rows_; }
  const std::vector<double>& points() const { return points_; }

 private:
  std::string failure() const {
    const std::string more = simulation_->failure();
    return more.empty() ? std::string(message(outcome_)) : more;
  }
  Json section_facts() const {
    if (!scenario_.section) return {};
    const Section& section = *scenario_.section;
    return {{"coordinate", section.coordinate},
            {"momentum", section.momentum},
            {"is_plane", !section.expression && !section.is_stroboscopic},
            {"value", section.value},
            {"direction", section.direction}};
  }
  Json observables() const {
    Json all = Json::array();
    for (const NamedExpression& each : scenario_.observables) {
      all.push_back({{"name", each.name}, {"expression", each.expression.text()}});
    }
    return all;
  }
  /// The values in the text, with the places where they stand.
  Json settings() const {
    Json all = Json::array();
    for (const auto& [path, each] : scenario_.settings) {
      all.push_back({{"path", path}, {"text", each.text}, {"line", each.line}, {"column", each.column}});
    }
    return all;
  }
  void append(const Frame& frame) {
    rows_.push_back(frame.time);
    rows_.insert(rows_.end(), frame.q.begin(), frame.q.end());
    rows_.insert(rows_.end(), frame.p.begin(), frame.p.end());
    rows_.push_back(frame.energy - start_.energy);
    for (const StateExpression& each : expressions_) rows_.push_back(each(frame));
  }
  void append_point(const SectionPoint& point) {
    points_.push_back(point.time);
    points_.insert(points_.end(), point.q.begin(), point.q.end());
    points_.insert(points_.end(), point.p.begin(), point.p.end());
  }

  Scenario scenario_;
  std::unique_ptr<Simulation> simulation_;
  EnergyBlocks blocks_;
  EveryStep rows_of_steps_;
  std::unique_ptr<SectionFinder> section_;
  std::vector<std::byte> start_bits_;
  Frame start_;
  Frame frame_;
  std::vector<StateExpression> expressions_;
  std::vector<double> rows_;
  std::vector<double> points_;
  Outcome outcome_ = Outcome::done;
  bool reversed_ = false;
};

std::vector<std::unique_ptr<Motion>> motions;
std::unique_ptr<Map> map_of_cells;
std::unique_ptr<Starts> starts;

Motion& motion(int number) { return *motions.at(static_cast<std::size_t>(number)); }

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    if (end > from) lines.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return lines;
}

}  // namespace
}  // namespace hamflow

using namespace hamflow;

extern "C" {

/// Reads a scenario and makes its motion, in the place `number`. `sets`: PATH=VALUE, one on each line.
EMSCRIPTEN_KEEPALIVE const char* hamflow_open(int number, const char* text, const char* sets) {
  return guarded([&]() -> Json {
    Reading reading = read_scenario_text(text, "scenario", lines_of(sets));
    if (!reading.complaints.empty()) return errors_of(reading.complaints);
    auto made = std::make_unique<Motion>(std::move(*reading.scenario));
    if (motions.size() <= static_cast<std::size_t>(number)) motions.resize(static_cast<std::size_t>(number) + 1);
    motions[static_cast<std::size_t>(number)] = std::move(made);
    return motion(number).facts();
  });
}

/// Chooses the expressions of the rows, one on each line.
EMSCRIPTEN_KEEPALIVE const char* hamflow_show(int number, const char* expressions) {
  return guarded([&]() -> Json {
    motion(number).show(lines_of(expressions));
    return {{"width", motion(number).width()}};
  });
}

EMSCRIPTEN_KEEPALIVE const char* hamflow_advance(int number, double steps, double every) {
  return guarded([&]() -> Json {
    motion(number).advance(static_cast<std::int64_t>(steps), static_cast<std::int64_t>(every));
    return motion(number).state();
  });
}

EMSCRIPTEN_KEEPALIVE const char* hamflow_state(int number) {
  return guarded([&] { return motion(number).state(); });
}
EMSCRIPTEN_KEEPALIVE const char* hamflow_reverse(int number) {
  return guarded([&] {
    motion(number).reverse();
    return motion(number).state();
  });
}
/// How many of the stored bits are those of the start.
EMSCRIPTEN_KEEPALIVE const char* hamflow_returned(int number) {
  return guarded([&] { return motion(number).reversal(); });
}
EMSCRIPTEN_KEEPALIVE const char* hamflow_certificate(int number) {
  return guarded([&] { return motion(number).certificate(); });
}

// The rows of the last advance (hamflow_show): width() numbers each; and the points of the section, t, q and p.
EMSCRIPTEN_KEEPALIVE const double* hamflow_rows(int number) { return motion(number).rows().data(); }
EMSCRIPTEN_KEEPALIVE int hamflow_count(int number) { return static_cast<int>(motion(number).rows().size()); }
EMSCRIPTEN_KEEPALIVE const double* hamflow_points(int number) { return motion(number).points().data(); }
EMSCRIPTEN_KEEPALIVE int hamflow_point_count(int number) { return static_cast<int>(motion(number).points().size()); }
EMSCRIPTEN_KEEPALIVE int hamflow_width(int number) { return static_cast<int>(motion(number).width()); }

/// The keys of a scenario with numbers.
EMSCRIPTEN_KEEPALIVE const char* hamflow_sweepable(int, const char* text) {
  return guarded([&]() -> Json {
    Json all = Json::array();
    for (const auto& [key, value] : sweepable_keys(text)) all.push_back({{"key", key}, {"value", value}});
    return all;
  });
}
EMSCRIPTEN_KEEPALIVE const char* hamflow_map(int, const char* text, const char* x, const char* y,
                                             const char* observable, double steps) {
  return guarded([&]() -> Json {
    map_of_cells = std::make_unique<Map>(text, x, y, observable, static_cast<std::int64_t>(steps));
    return {{"columns", map_of_cells->columns()}, {"rows", map_of_cells->rows()}, {"lanes", map_of_cells->lanes()}};
  });
}
EMSCRIPTEN_KEEPALIVE const char* hamflow_cells(int, double first, double stride, double count, double milliseconds) {
  return guarded([&]() -> Json {
    if (map_of_cells == nullptr) throw Error("found no map; begin one first");
    map_of_cells->compute(static_cast<std::size_t>(first), static_cast<std::size_t>(stride),
                          static_cast<std::size_t>(count), milliseconds);
    return {{"done", map_of_cells->numbers().size()}};
  });
}
EMSCRIPTEN_KEEPALIVE const double* hamflow_cell_numbers(int) { return map_of_cells->numbers().data(); }
EMSCRIPTEN_KEEPALIVE int hamflow_cell_count(int) { return static_cast<int>(map_of_cells->numbers().size()); }

EMSCRIPTEN_KEEPALIVE const char* hamflow_starts(int, const char* text, const char* sets) {
  return guarded([&]() -> Json {
    starts = std::make_unique<Starts>(text, lines_of(sets));
    return {{"starts", starts->counts().size()}};
  });
}
EMSCRIPTEN_KEEPALIVE const char* hamflow_points_of_starts(int, double most, double milliseconds) {
  return guarded([&]() -> Json {
    if (starts == nullptr) throw Error("found no starts; give some first");
    starts->advance(static_cast<std::int64_t>(most), milliseconds);
    return {{"step", starts->step()}, {"counts", starts->counts()}, {"failures", starts->failures()}};
  });
}
EMSCRIPTEN_KEEPALIVE const double* hamflow_start_numbers(int) { return starts->points().data(); }
EMSCRIPTEN_KEEPALIVE int hamflow_start_number_count(int) { return static_cast<int>(starts->points().size()); }

}  // extern "C"
