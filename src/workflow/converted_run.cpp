#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "converted_text.hpp"
#include "csv_file.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/workflow/convert.hpp"
#include "json_text.hpp"
#include "run_copy.hpp"
#include "run_description.hpp"
#include "run_file.hpp"
#include "run_keys.hpp"
#include "scenario_edit.hpp"

namespace hamflow {

namespace fs = std::filesystem;

namespace {

constexpr double most_certain_turn = 2;  // radians from one sample to the next

/// The samples of a run in other coordinates of its problem.
class SampleConversion {
 public:
  SampleConversion(const Scenario& scenario, const Table& given, const std::string& to)
      : scenario_(scenario), given_(given), target_(in_coordinates(scenario.problem, to)) {}

  ConvertedSamples all() const {
    ConvertedSamples found;
    found.names = state_names(*target_, scenario_.request.parameters, target_->info.coordinates.size());
    const std::size_t size = target_->info.coordinates.size();
    const auto list = [&](const char* name, const std::vector<std::string>& parts, const char* meaning) {
      return ColumnInfo{.name = name, .width = size, .scalar = false, .parts = parts, .meaning = meaning};
    };
    const auto digits_of = [&](ColumnInfo info) {
      info.name = "digits/" + info.name;
      info.type = ValueType::text;
      info.text_size = longest_digits(scenario_.request.arithmetic);
      return Column(info);
    };
    const ColumnInfo of_q = list("q", found.names.q, "coordinates, converted");
    const ColumnInfo of_p = list("p", found.names.p, "canonical momenta, converted");
    Column q(of_q);
    Column p(of_p);
    Column q_digits = digits_of(of_q);
    Column p_digits = digits_of(of_p);
    StateConverter convert(scenario_.problem, target_, scenario_.request.parameters);
    for (std::size_t k = 0; k < given_.rows(); ++k) {
      try {
        CanonicalState state = convert({given_["q"].row(k), given_["p"].row(k)});
        if (has_digits()) {
          const DigitState digits =
              convert_digits(state, {given_["digits/q"].row_of_texts(k), given_["digits/p"].row_of_texts(k)});
          for (const std::string& x : digits.q) q_digits.add(x);
          for (const std::string& x : digits.p) p_digits.add(x);
        }
        for (const double x : state.q) q.add(x);
        for (const double x : state.p) p.add(x);
      } catch (const Error& error) {
        throw Error(fmt::format("sample {}, t = {}: {}", k, shortest(given_["t"].numbers()[k]), error.what()));
      }
    }
    found.table.add(std::move(q));
    found.table.add(std::move(p));
    if (has_digits()) {
      found.table.add(std::move(q_digits));
      found.table.add(std::move(p_digits));
      for (const auto& [name, meaning] : {std::pair{"energy", "H(q, p)"}, std::pair{"t", "time"}}) {
        Column column = digits_of({.name = name, .parts = {name}, .meaning = meaning});
        for (const std::string& x : given_[std::string("digits/") + name].texts()) column.add(x);
        found.table.add(std::move(column));
      }
    }
    found.note = note_of_turns(convert, found.table);
    return found;
  }

 private:
  bool has_digits() const { return given_.find("digits/t") != nullptr; }
  /// Returns a note if whole turns of an angle may be missing between samples; else empty.
  std::string note_of_turns(const StateConverter& convert, const Table& states) const {
    const double largest = std::max(convert.largest_turn(), fastest_turn(convert.turning(), states));
    if (!(largest > most_certain_turn)) return {};
    return fmt::format(
        "{} changes by up to {:.3g} rad from one sample to the next; if that is more than half a turn, whole turns are "
        "lost",
        joined(convert.turning(), [this](std::size_t i) { return target_->info.coordinates[i]; }), largest);
  }

  /// Converts a state in the arithmetic of the run and adds the whole turns of the state in double. Then it rounds the
  /// digits to double into `in_double`.
  DigitState convert_digits(CanonicalState& in_double, const DigitState& given) const {
    DigitState state = in_chart_of(*target_, *without_own_walls(scenario_.problem), scenario_.request.parameters,
                                   scenario_.request.arithmetic, given);
    for (std::size_t i = 0; i < state.q.size(); ++i) {
      const auto& angles = target_->info.angles;
      if (std::find(angles.begin(), angles.end(), target_->info.coordinates[i]) != angles.end()) {
        const double missing = in_double.q[i] - evaluate_number<double>(state.q[i]);
        state.q[i] = turned(state.q[i], std::llround(missing / (2 * pi_value<double>())), scenario_.request.arithmetic);
      }
      in_double.q[i] = evaluate_number<double>(state.q[i]);
      in_double.p[i] = evaluate_number<double>(state.p[i]);
    }
    return state;
  }
  /// Returns the largest product of the rate of an angle and the time to the next sample. It shows whether whole turns
  /// may be lost.
  double fastest_turn(const std::vector<std::size_t>& angles, const Table& states) const {
    double most = 0;
    const std::span<const double> t = given_["t"].numbers();
    for (std::size_t k = 0; k + 1 < t.size() && !angles.empty(); ++k) {
      const std::vector<double> rates =
          target_->gradient(scenario_.request.parameters, states["q"].row(k), states["p"].row(k)).by_p;
      for (const std::size_t i : angles) most = std::max(most, std::abs(rates[i] * (t[k + 1] - t[k])));
    }
    return most;
  }

  const Scenario& scenario_;
  const Table& given_;
  std::shared_ptr<const ProblemEntry> target_;  // the problem in the coordinates `to`
};

}  // namespace

ConvertedSamples converted_samples(const Scenario& scenario, const Table& samples, const std::string& to) {
  return SampleConversion(scenario, samples, to).all();
}

class ConvertedRun::Impl {
 public:
  Impl(const fs::path& file, const std::string& to)
      : file_(file), to_(to), run_(read_run_file(file, {.digits = true})), given_(run_.tables.samples) {
    if (given_.find("energy") == nullptr && given_.rows() > 0) {
      throw FileError(file.string() +
                      " cannot be converted: it contains the states of a reversal; allowed the run.h5 of a run");
    }
    const std::string& text = run_.description.scenario;
    reading_ = read_scenario_text(text, file.string(), {});
    if (!reading_.scenario) {
      throw FileError("the scenario in " + file.string() + " is damaged: " + reading_.complaints.front().text());
    }
    check_states(scenario(), run_.description, file);
    target_ = in_coordinates(scenario().problem, to);
    from_ = coordinates_of(*scenario().problem);
    states_ = converted_samples(scenario(), given_, to);
  }

  std::string csv() const {
    std::string text =
        fmt::format("t,{},{},energy\n", fmt::join(states_.names.q, ","), fmt::join(states_.names.p, ","));
    for (std::size_t k = 0; k < given_.rows(); ++k) {
      if (has_digits()) {
        text += fmt::format("{},{},{},{}\n", given_["digits/t"].text(k),
                            fmt::join(states_.table["digits/q"].row_of_texts(k), ","),
                            fmt::join(states_.table["digits/p"].row_of_texts(k), ","), given_["digits/energy"].text(k));
        continue;
      }
      text += fmt::format("{:.17g}", given_["t"].numbers()[k]);
      for (const char* name : {"q", "p"}) {
        for (const double x : states_.table[name].row(k)) text += fmt::format(",{:.17g}", without_sign_of_nan(x));
      }
      text += fmt::format(",{:.17g}\n", without_sign_of_nan(given_["energy"].numbers()[k]));
    }
    return text;
  }
  std::string json() const {
    nlohmann::ordered_json all{{"coordinates", to_}};
    const auto rows_of = [&](const std::string& name) {
      nlohmann::ordered_json rows = nlohmann::ordered_json::array();
      for (std::size_t k = 0; k < given_.rows(); ++k) {
        if (has_digits()) {
          rows.push_back(states_.table["digits/" + name].row_of_texts(k));
        } else {
          rows.push_back(states_.table[name].row(k));
        }
      }
      return rows;
    };
    const auto column_of = [&](const std::string& name) -> nlohmann::ordered_json {
      if (has_digits()) return given_["digits/" + name].texts();
      return given_[name].part(0);
    };
    all["t"] = column_of("t");
    all["q"] = rows_of("q");
    all["p"] = rows_of("p");
    all["energy"] = column_of("energy");
    return json_text(all);
  }
  std::string write_h5(const fs::path& target) const {
    const CanonicalState start = StateConverter(
        scenario().problem, target_, scenario().request.parameters)({scenario().start_q, scenario().start_p});
    std::string note;
    std::string text =
        "# Samples of a run in " + from_ + " coordinates, converted by hamflow convert to " + to_ + ".\n";
    const std::string same_settings = converted_text(scenario(), to_, start);
    if (read_scenario_text(same_settings, "the converted scenario", {}).scenario) {
      text += same_settings;
    } else {
      const std::string method = run_.description.method;
      text += "# They were computed by " + method + " with settings that these coordinates do not allow.\n";
      const std::string other = target_->constraint_form.empty() ? "cg" : "rattle";
      note = "the samples were computed by " + method + " with settings that " + to_ +
             " coordinates do not allow; the scenario in " + target.string() + " names " + other + " in double instead";
      Scenario changed = scenario();
      changed.text = edited_scenario(changed.text, {{"method", "{ name = \"" + other + "\" }"},
                                                    {run_path(run_keys().arithmetic), {}},
                                                    {run_path(run_keys().lattice), {}}});
      text += converted_text(changed, to_, start);
    }
    (void)accepted(read_scenario_text(text, "the converted scenario", {}));
    const OmittedFromCopy left_out = copy_run_file(
        file_, target,
        {.scenario = text, .coordinates = states_.names.q, .momenta = states_.names.p, .table = states_.table});
    if (!left_out.tables.empty()) {
      note += fmt::format("{}left out of {}: {}, which hold states in {} coordinates", note.empty() ? "" : "; ",
                          target.string(), fmt::join(left_out.tables, ", "), from_);
    }
    if (!left_out.others.empty()) {
      note += fmt::format("{}left out of {}: {}", note.empty() ? "" : "; ", target.string(),
                          fmt::join(left_out.others, ", "));
    }
    return note;
  }
  const std::string& note() const { return states_.note; }
  std::string left_out() const { return left_out_of_converted(scenario(), to_); }
  std::vector<std::string> columns_left_out() const {
    std::vector<std::string> all{"step"};
    for (const InvariantColumn& column : csv_columns(scenario())) all.push_back(column.name);
    return all;
  }

 private:
  const Scenario& scenario() const { return *reading_.scenario; }
  bool has_digits() const { return given_.find("digits/t") != nullptr; }

  fs::path file_;
  std::string to_;
  std::string from_;
  StoredRun run_;
  const Table& given_;  // its samples
  Reading reading_;
  ConvertedSamples states_;
  std::shared_ptr<const ProblemEntry> target_{};  // the problem in the coordinates `to`
};

ConvertedRun::ConvertedRun(const fs::path& run, const std::string& to)
    : impl_(std::make_unique<Impl>(fs::is_directory(run) ? run / "run.h5" : run, to)) {}
ConvertedRun::~ConvertedRun() = default;
std::string ConvertedRun::csv() const { return impl_->csv(); }
std::string ConvertedRun::json() const { return impl_->json(); }
std::string ConvertedRun::write_h5(const fs::path& target) const { return impl_->write_h5(target); }
const std::string& ConvertedRun::note() const { return impl_->note(); }
std::string ConvertedRun::left_out() const { return impl_->left_out(); }
std::vector<std::string> ConvertedRun::columns_left_out() const { return impl_->columns_left_out(); }

}  // namespace hamflow
