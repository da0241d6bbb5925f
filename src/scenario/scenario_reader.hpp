// Reads a parsed document table by table into a scenario.
#pragma once

#include "body_list.hpp"
#include "gas_start.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/walls.hpp"
#include "run_keys.hpp"
#include "toml_table.hpp"

namespace hamflow {

struct FigureFacts;

struct Document {
  toml::table root;
  std::string file_method;                  // name of the method in the file, before any --set
  std::optional<std::string> resumed_in{};  // folder of a resumed run; empty text: the folder of the scenario
};

/// Parses a text and applies every --set. If the text is not TOML, it complains and returns nullopt.
std::optional<Document> parsed_document(const std::string& text, const std::string& name,
                                        const std::vector<std::string>& sets, std::vector<Complaint>& complaints);
/// Returns the text of the scenario that is run: the text of the file or, if a key was set from outside, the document
/// as text. `run` reads it without any --set.
std::string effective_text(const std::string& text, const std::vector<std::string>& sets, const toml::table& root);
/// Returns every value by its dotted path.
std::map<std::string, Setting> settings_of(const toml::table& root);

/// Returns whether [problem] has a typed choice (ProblemInfo::typed_choice).
bool has_typed_choice(TomlTable& table, const ProblemInfo& info);

/// Reads and checks the parts of one scenario. Each function collects complaints and continues.
class ScenarioReader {
 public:
  ScenarioReader(const Document& document, const std::string& file, std::vector<Complaint>& complaints)
      : root_(&document.root, "", file, complaints),
        complaints_(complaints),
        file_method_(document.file_method),
        resumed_in_(document.resumed_in),
        document_(document.root) {
    scenario_.file = file;
  }

  Scenario read() {
    TomlTable problem = root_.table("problem");
    TomlTable method = root_.table("method");
    TomlTable run = root_.table(run_table);
    TomlTable output = root_.table(output_table);
    read_functions(run);
    read_problem(problem);
    read_method(method);
    read_run(run);
    check_walls();
    check_gas();
    check_method_for_size(method);
    check_massless(method, run);
    check_kepler_splitting(method);
    read_output(output);
    root_.finish();
    return std::move(scenario_);
  }

  /// Reads only [problem].
  Scenario read_problem_alone() {
    TomlTable problem = root_.table("problem");
    read_problem(problem);
    return scenario_;
  }

  /// Explains why no start has the requested energy; empty if one has, or no energy was requested.
  const std::string& no_start() const { return no_start_; }

 private:
  void read_problem(TomlTable& table);
  void read_without_variant(TomlTable& table, const std::string& name);
  void read_variant(TomlTable& table, const std::string& name);
  void read_address(TomlTable& table);
  static std::vector<std::string> choices_of_key(const std::string& name, const std::string& key);
  void read_typed_problem(TomlTable& table, const ProblemEntry& listed);
  std::optional<FormulaTexts> read_formula_texts(TomlTable& table);
  static void report_other_formulas(TomlTable& table, FormulaTexts texts, std::string wrong);
  Texts read_typed_parameters(TomlTable& table);
  void check_invariant_names(TomlTable& table, const FormulaTexts& texts);
  void note_constant_coordinates(const FormulaTexts& texts);
  void refuse_unused_parameters(TomlTable& table, const FormulaTexts& texts);
  void read_gas(TomlTable& table);
  void read_typed_pair(TomlTable& table, Texts& parameters);
  void note_unused_start(const TomlTable& table);
  std::filesystem::path resumed_run();
  static GasStart without_own_masses(const TomlTable& table, GasStart start);
  GasStart read_gas_start(TomlTable& table, std::int64_t n, std::size_t space, const Texts& parameters);
  void read_scale(TomlTable& table, std::int64_t n, std::size_t size, Texts& parameters);
  void read_box(TomlTable& table);
  void check_gas();
  void check_branches();
  void check_parameters(TomlTable& table, bool start_is_known);
  void read_numbered_start(TomlTable& table);
  void read_orbit(TomlTable& table);
  void refuse_derived(TomlTable& table, const StartInfo& start, const std::string& because);
  void read_bodies(TomlTable& table);
  void read_units(TomlTable& table);
  void read_body_list(TomlTable& table);
  void check_space(std::vector<TomlTable>& tables);
  void check_barycentre(std::vector<TomlTable>& tables);
  void check_places(TomlTable& table);
  void check_kepler_splitting(TomlTable& method);
  void check_massless(TomlTable& method, TomlTable& run);
  void place_bodies(TomlTable& table, const std::string& arithmetic);
  bool check_masses(TomlTable& table);
  bool check_size(TomlTable& table);
  void read_initial(TomlTable& table);
  void read_start_energy(TomlTable& initial);
  void read_frame(TomlTable& table);
  void read_walls(TomlTable& table);
  void check_walls();
  bool complain_of_soft_walls();
  void check_start(TomlTable& table);
  void complain_of_start(TomlTable& table, const std::string& usual, const StartRefusal& refusal);
  void complain_of_particles(TomlTable& table, const std::string& usual, const StartRefusal& refusal);
  bool check_constraints(TomlTable& table, const Frame& start);
  void read_method(TomlTable& table);
  bool has_method() const { return !scenario_.request.method.name.empty(); }
  bool read_method_name(TomlTable& table);
  void complain_of_method(TomlTable& table, const std::string& why_not);
  void check_method_for_size(TomlTable& table);
  void read_functions(TomlTable& table);
  void read_arithmetic(TomlTable& table);
  void read_run(TomlTable& table);
  void read_map(TomlTable& table);
  void read_threads(TomlTable& table);
  void read_length(TomlTable& table);
  bool refuse_time(TomlTable& table, const std::string& key, const std::string& allowed);
  void read_measures(TomlTable& table);
  void refuse_derivative(TomlTable& table, const std::string& key);
  void read_section(TomlTable& table);
  void read_events(TomlTable& table);
  void read_section_coordinate(TomlTable& section, Section wanted);
  void read_section_expression(TomlTable& section, Section wanted);
  std::optional<StateExpression> read_expression(TomlTable& table, const OptionInfo& key);
  ExpressionInDigits in_digits(const StateExpression& expression) const;
  std::optional<StateExpression> read_changing_expression(TomlTable& table, const OptionInfo& key);
  void read_observables(TomlTable& table);
  void read_elements(TomlTable& table);
  void read_samples(TomlTable& table);
  void usual_units();
  void round_edges(TomlTable& table);
  void read_lattice(TomlTable& table);
  void read_output(TomlTable& table);
  FigureFacts figure_facts() const;

  TomlTable root_;
  std::vector<Complaint>& complaints_;
  std::string file_method_;
  const std::optional<std::string>& resumed_in_;
  const toml::table& document_;
  std::string no_start_;
  std::string driven_hamiltonian_;        // text of H(q, p, t); empty if H does not depend on t
  std::vector<std::size_t> start_lines_;  // lines of the particles in the CSV file of a gas
  StartSpec start_of_bodies_;             // start as expressions that every arithmetic evaluates with all its digits
  BodyList body_list_;                    // bodies of n-body
  Scenario scenario_;
  std::optional<FunctionsInUse> functions_;
};

}  // namespace hamflow
