#include "hamflow/detail/run/state_expression.hpp"

#include <algorithm>
#include <vector>

#include "hamflow/detail/run/expression_in_digits.hpp"
#include "hamflow/formula/formula.hpp"
#include "hamflow/run/state_names.hpp"

namespace hamflow {

namespace {

void append(std::vector<std::string>& all, const StateNames& names) {
  all.insert(all.end(), names.q.begin(), names.q.end());
  all.insert(all.end(), names.p.begin(), names.p.end());
}

/// The names of the state, then the time, then parameters (k, masses[1]) with their values and texts.
FormulaSymbols symbols_of(const ProblemEntry& problem, const Texts& parameters, std::size_t size, bool& numbered,
                          std::vector<double>& values, std::vector<std::string>& texts) {
  FormulaSymbols symbols{.names = {}, .known = {}, .what = "coordinates, momenta and parameters"};
  const StateNames names = state_names(problem, parameters, size);
  append(symbols.names, names);
  const StateNames by_number = numbered_names(size);
  numbered = problem.dimension == 0 && names.q != by_number.q;
  if (numbered) append(symbols.names, by_number);
  symbols.names.emplace_back("t");
  const Parameters<double> given(parameters);
  const auto add = [&](const std::string& name, double value, const std::string& text) {
    if (std::find(symbols.names.begin(), symbols.names.end(), name) != symbols.names.end()) return;
    symbols.names.push_back(name);
    symbols.known[name] = value;
    values.push_back(value);
    texts.push_back(text);
  };
  for (const ParameterInfo& parameter : problem.info.parameters) {
    if (!given.has(parameter.name)) continue;
    const std::vector<double>& list = given.list(parameter.name);
    const std::vector<std::string> parts = list_parts(parameters.at(parameter.name));
    if (parameter.type != OptionType::list && list.size() == 1) add(parameter.name, list[0], parts.at(0));
    if (parameter.type == OptionType::number) continue;
    for (std::size_t i = 0; i < list.size(); ++i) {
      add(parameter.name + "[" + std::to_string(i + 1) + "]", list[i], parts.at(i));
    }
  }
  return symbols;
}

}  // namespace

struct StateExpression::Read {
  std::string text;
  std::size_t size = 0;
  std::vector<double> parameters;  // after q, p, the numbered names of q and p if they have other names, and t
  bool numbered = false;
  Formula formula;
  formula::BoundCode<double> code;
};

StateExpression::StateExpression(const std::string& text, const ProblemEntry& problem, const Texts& parameters,
                                 std::size_t size) {
  const auto read = std::make_shared<Read>();
  read->text = text;
  read->size = size;
  std::vector<std::string> texts;
  const FormulaSymbols symbols = symbols_of(problem, parameters, size, read->numbered, read->parameters, texts);
  read->formula = parse_formula(text, symbols);
  read->code = read->formula.bind<double>();
  read_ = read;
}

const std::string& StateExpression::text() const { return read_->text; }

bool StateExpression::uses(std::size_t k) const {
  return read_->formula.uses(static_cast<int>(k)) ||
         (read_->numbered && read_->formula.uses(static_cast<int>(k + 2 * read_->size)));
}

bool StateExpression::uses_time() const {
  return read_->formula.uses(static_cast<int>((read_->numbered ? 4 : 2) * read_->size));
}

std::optional<Operand> StateExpression::append_to(Program& program, std::span<const Operand> state) const {
  if (uses_time()) return std::nullopt;
  const std::size_t of_state = (read_->numbered ? 4 : 2) * read_->size;
  const auto constant = [&](double c) -> Operand {
    program.constants.push_back(c);
    return {Operand::Kind::constant, static_cast<std::uint32_t>(program.constants.size() - 1)};
  };
  const Program own = formula::program_of(read_->code.code(), read_->code.constants());
  std::vector<Operand> symbols;
  for (const int symbol : read_->code.code().symbols) {
    const auto k = static_cast<std::size_t>(symbol);
    symbols.push_back(k > of_state ? constant(read_->parameters[k - of_state - 1]) : state[k % (2 * read_->size)]);
  }
  std::vector<Operand> results;
  const auto moved = [&](const Operand& x) -> Operand {
    switch (x.kind) {
      case Operand::Kind::carried:
        return symbols[x.index];
      case Operand::Kind::result:
        return results[x.index];
      case Operand::Kind::constant:
        return constant(own.constants[x.index]);
      case Operand::Kind::none:
        break;
    }
    return x;
  };
  for (const Program::Operation& operation : own.operations) {
    const Program::Operation here{operation.instruction, moved(operation.a), moved(operation.b), moved(operation.c)};
    program.operations.push_back(here);
    results.push_back({Operand::Kind::result, static_cast<std::uint32_t>(program.operations.size() - 1)});
  }
  return moved(own.outputs.back());
}

double StateExpression::operator()(const Frame& frame) const {
  const std::size_t n = read_->size;
  const std::size_t of_state = (read_->numbered ? 4 : 2) * n;
  const auto value_of = [&](int symbol) -> double {
    const auto k = static_cast<std::size_t>(symbol);
    if (k > of_state) return read_->parameters[k - of_state - 1];
    if (k == of_state) return frame.time;
    const std::size_t at = k % (2 * n);
    return at < n ? frame.q[at] : frame.p[at - n];
  };
  double result = 0;
  read_->code.run<double>(value_of, [&](std::size_t, double value) { result = value; });
  return result;
}

ExpressionInDigits expression_in_digits(const std::string& text, const ProblemEntry& problem, const Texts& parameters,
                                        std::size_t size) {
  bool numbered = false;
  std::vector<double> rounded;
  std::vector<std::string> texts;  // texts of the parameters
  const FormulaSymbols symbols = symbols_of(problem, parameters, size, numbered, rounded, texts);
  const std::size_t of_state = (numbered ? 4 : 2) * size;
  return [formula = parse_formula(text, symbols), texts, of_state, size](const FrameDigits& digits) {
    const auto value_of = [&](int symbol) -> Mp {
      const auto k = static_cast<std::size_t>(symbol);
      if (k > of_state) return evaluate_number<Mp>(texts[k - of_state - 1]);
      if (k == of_state) return parse_decimal<Mp>(digits.time);
      const std::size_t at = k % (2 * size);
      return parse_decimal<Mp>(at < size ? digits.q[at] : digits.p[at - size]);
    };
    Mp result(0);
    formula.bind<Mp>().run<Mp>(value_of, [&](std::size_t, const Mp& value) { result = value; });
    return result;
  };
}

}  // namespace hamflow
