#include "hamflow/detail/formula/model.hpp"

#include <algorithm>
#include <set>

#include "choices.hpp"
#include "emission.hpp"
#include "form.hpp"
#include "names.hpp"

namespace hamflow::formula {

namespace {
constexpr std::size_t longest = 4'000'000;  // limit for the factors of all forms; they take some hundred megabytes
}  // namespace

/// The graph and the forms of the texts. They are kept for second derivatives.
struct Model::Derivation {
  Derivation(const Graph& read, const std::vector<bool>& fixed_symbols)
      : graph(read), fixed(fixed_symbols), forms(graph, fixed_symbols, longest) {}

  /// A form that code has to compute, or its negative.
  struct Output {
    int form;
    bool negative = false;
    int scale = -1;
  };
  std::shared_ptr<const Code> code(const std::vector<Output>& outputs) {
    Graph out;
    Emission emission(forms, out);
    std::vector<int> nodes;
    for (const Output& o : outputs) {
      nodes.push_back(o.scale < 0 ? emission.value(o.form, o.negative)
                                  : emission.scaled_value(o.form, o.scale, o.negative));
    }
    return std::make_shared<const Code>(code_of(out, nodes, fixed));
  }
  /// Returns code for a + b that computes both forms separately and adds them.
  std::shared_ptr<const Code> code_of_sum(int a, int b) {
    Graph out;
    Emission emission(forms, out);
    const int left = emission.value(a);
    const std::vector<int> nodes{out.node(Op::add, left, emission.value(b))};
    return std::make_shared<const Code>(code_of(out, nodes, fixed));
  }

  int symbol(std::size_t index) { return forms.symbol(static_cast<int>(index)); }
  int derivative(int form, std::size_t by) { return forms.derivative(form, static_cast<int>(by)); }

  Graph graph;
  std::vector<bool> fixed;
  Forms forms;
  int h = -1;
  int t = -1;  // the form of T, if H is separable
  int v = -1;
};

namespace {

/// Whether a factor depends on coordinates or time (q), and on momenta (p).
struct Kinds {
  bool q = false;
  bool p = false;
};
Kinds kinds_of(const Forms& forms, const Factor& factor, std::size_t n) {
  Kinds kinds;
  for (const int v : forms.base_at(factor.base).variables) {
    const auto symbol = static_cast<std::size_t>(v);
    kinds.q = kinds.q || symbol < n || symbol == 2 * n;
    kinds.p = kinds.p || (symbol >= n && symbol < 2 * n);
  }
  return kinds;
}

/// Expands a constant times a sum if the sum contains both q and p, such as (p^2 + q^2)/2.
/// @param before the product of the constants before all enclosing sums, if there are any
void spread(Forms& forms, int form, std::size_t n, std::vector<Term>& out, std::optional<int> before = {},
            int depth = 0) {
  constexpr int most_nested = 1000;
  if (depth > most_nested) throw Error("found sums nested more than 1000 deep; allowed at most 1000");
  const std::vector<Term> terms = forms[form].terms;
  for (const Term& term : terms) {
    std::optional<std::size_t> group;
    bool others = false;
    for (std::size_t k = 0; k < term.factors.size(); ++k) {
      const Factor& f = term.factors[k];
      if (forms.is_constant(f)) continue;
      const bool is_group = forms.base_at(f.base).kind == Base::Kind::group && f.exponent.is(1) && !group;
      if (is_group) {
        group = k;
      } else {
        others = true;
      }
    }
    const auto mixed = [&](const Factor& f) {
      const Kinds in = kinds_of(forms, f, n);
      return in.q && in.p;
    };
    if (!group || others || !mixed(term.factors[*group])) {
      if (!before) {
        out.push_back(term);
        continue;
      }
      const Form& product = forms[forms.product(*before, forms.of_terms({term}))];
      out.insert(out.end(), product.terms.begin(), product.terms.end());
      continue;
    }
    Term constants = term;
    constants.factors.erase(constants.factors.begin() + static_cast<std::ptrdiff_t>(*group));
    const int own = forms.of_terms({constants});
    const int inside = forms.base_at(term.factors[*group].base).a;
    spread(forms, inside, n, out, before ? forms.product(*before, own) : own, depth + 1);
  }
}

/// Splits H into T and V, if every term depends only on p or only on q.
std::optional<std::pair<int, int>> parts_of(Forms& forms, int h, std::size_t n) {
  std::vector<Term> all;
  spread(forms, h, n, all);
  std::vector<Term> of_p;
  std::vector<Term> of_q;
  for (const Term& term : all) {
    bool p = false;
    bool q = false;
    for (const Factor& f : term.factors) {
      const Kinds in = kinds_of(forms, f, n);
      q = q || in.q;
      p = p || in.p;
    }
    if (p && q) return std::nullopt;
    (p ? of_p : of_q).push_back(term);
  }
  return std::pair{forms.of_terms(of_p), forms.of_terms(of_q)};
}

/// Whether a form is linear in the momenta: every term is a constant times a momentum, or times a sum of such terms, as
/// in 0.5*(2*p_x + p_y).
bool is_linear(const Forms& forms, int form, std::size_t n) {
  const std::vector<Term>& terms = forms[form].terms;
  return std::all_of(terms.begin(), terms.end(), [&](const Term& term) {
    bool linear = false;  // whether there is exactly one factor that varies
    for (const Factor& f : term.factors) {
      if (forms.is_constant(f)) continue;
      const Base& base = forms.base_at(f.base);
      const auto symbol = static_cast<std::size_t>(base.a);
      const bool is_momentum = base.kind == Base::Kind::symbol && symbol >= n && symbol < 2 * n;
      const bool is_sum = base.kind == Base::Kind::group && is_linear(forms, base.a, n);
      if (linear || !f.exponent.is(1) || (!is_momentum && !is_sum)) return false;
      linear = true;
    }
    return linear;
  });
}

/// Whether the derivatives have the form s x_i, each a single term with the same scalar s.
bool is_one_scalar(Forms& forms, const std::vector<int>& derivatives, std::size_t first) {
  std::optional<int> scalar;
  for (std::size_t i = 0; i < derivatives.size(); ++i) {
    const int by = forms.symbol(static_cast<int>(first + i));
    if (forms[derivatives[i]].terms.size() != 1) return false;
    const int own = forms.product(derivatives[i], forms.power(by, {-1, 1}));
    for (const Factor& f : forms[own].terms.at(0).factors) {
      if (forms.base_at(f.base).kind == Base::Kind::symbol && !forms.is_constant(f)) return false;
    }
    if (scalar && *scalar != own) return false;
    scalar = own;
  }
  return scalar.has_value();
}

}  // namespace

Model::~Model() = default;

Model::Model(const FormulaTexts& texts) {
  const ProblemNames names = names_of(texts);
  coordinates_ = names.coordinates;
  momenta_ = names.momenta;
  symbols_ = symbols_of(names);
  for (const ProblemNames::Parameter& p : names.parameters) {
    for (std::size_t i = 0; i < std::max<std::size_t>(p.length, 1); ++i) places_.push_back({p.name, i});
  }
  label_ = "formula";
  for (const auto& [key, text] : choices_of(texts)) label_ += " " + key + " = " + text;
  const std::size_t n = size();
  const auto refuse = [](const std::string& key, const std::string& message) { throw FormulaError(key, message); };
  const bool whole = !texts.hamiltonian.empty();
  const bool split = !texts.kinetic.empty() && !texts.potential.empty();
  if (whole && (!texts.kinetic.empty() || !texts.potential.empty())) {
    refuse(FormulaKeys::hamiltonian,
           "found together with " + std::string(texts.kinetic.empty() ? FormulaKeys::potential : FormulaKeys::kinetic) +
               "; allowed hamiltonian, or kinetic and potential");
  }
  if (!whole && !split) {
    const bool none = texts.kinetic.empty() && texts.potential.empty();
    refuse(none                    ? FormulaKeys::hamiltonian
           : texts.kinetic.empty() ? FormulaKeys::kinetic
                                   : FormulaKeys::potential,
           "missing; allowed hamiltonian, or kinetic and potential");
  }

  Graph graph;
  std::set<std::string> needed = names.whole;
  const auto read_with = [&](const FormulaSymbols& symbols, const std::string& key, const std::string& text) {
    try {
      return read_into(graph, text, symbols, &needed);
    } catch (const Error& error) {
      throw FormulaError(key, error.what());
    }
  };
  const auto read = [&](const std::string& key, const std::string& text) { return read_with(symbols_, key, text); };
  std::vector<int> roots;
  if (whole) {
    roots.push_back(read(FormulaKeys::hamiltonian, texts.hamiltonian));
  } else {
    roots.push_back(read(FormulaKeys::kinetic, texts.kinetic));
    roots.push_back(read(FormulaKeys::potential, texts.potential));
  }
  const std::size_t first_invariant = roots.size();
  std::set<std::string> known_invariants;
  for (const auto& [name, text] : texts.invariants) {
    const std::string key = std::string(FormulaKeys::invariants) + "." + name;
    if (!known_invariants.insert(name).second)
      refuse(key, "found the name " + name + " a second time; allowed names that differ");
    roots.push_back(read(key, text));
    invariant_names_.push_back(name);
  }
  const std::size_t first_constraint = roots.size();
  for (std::size_t k = 0; k < texts.constraints.size(); ++k) {
    const std::string key = std::string(FormulaKeys::constraints) + "[" + std::to_string(k) + "]";
    try {
      roots.push_back(read_into(graph, texts.constraints[k], symbols_, &needed));
    } catch (const Error&) {  // it is parsed again below, where the message lists the allowed names
      FormulaSymbols own = symbols_;
      own.what = "coordinates and parameters";
      own.names.erase(own.names.begin() + static_cast<std::ptrdiff_t>(n),
                      own.names.begin() + static_cast<std::ptrdiff_t>(2 * n + 1));
      (void)read_with(own, key, texts.constraints[k]);
      throw;
    }
  }
  structure_.constraints = texts.constraints.size();
  structure_.multiplier = texts.constraint_form == FormulaKeys::multiplier;
  std::erase_if(symbols_.known, [&](const auto& entry) { return !needed.contains(entry.first); });

  std::vector<bool> fixed(symbols_.names.size(), true);
  fixed.resize(symbols_.names.size() + 3, false);  // the factor, the momenta of the time
  for (std::size_t i = 0; i <= 2 * n; ++i) fixed[i] = false;
  derivation_ = std::make_unique<Derivation>(graph, fixed);
  Derivation& d = *derivation_;
  const std::string key = whole ? FormulaKeys::hamiltonian : FormulaKeys::potential;
  try {
    if (whole) {
      d.h = d.forms.of_node(roots[0]);
      if (const auto parts = parts_of(d.forms, d.h, n)) {
        d.t = parts->first;
        d.v = parts->second;
      }
    } else {
      d.t = d.forms.of_node(roots[0]);
      d.v = d.forms.of_node(roots[1]);
      const auto foreign = [&](int form, std::size_t first, const char* own, const char* of) {
        for (std::size_t i = 0; i < n; ++i) {
          if (!d.forms.depends(form, static_cast<int>(first + i))) continue;
          refuse(own, "found " + symbols_.names[first + i] + " in it; allowed " + of +
                          ", parameters and t; otherwise give hamiltonian");
        }
      };
      foreign(d.t, 0, FormulaKeys::kinetic, "momenta");
      foreign(d.v, n, FormulaKeys::potential, "coordinates");
      d.h = d.forms.sum({d.t, d.v});
      if (d.forms.depends(d.t, static_cast<int>(time_symbol()))) d.t = d.v = -1;
    }
    structure_.time = d.forms.depends(d.h, static_cast<int>(time_symbol()));
    structure_.separable = d.t >= 0;
    if (structure_.time) {
      const int momentum = d.symbol(time_momentum_symbol());
      d.h = d.forms.sum({d.h, momentum});
      if (structure_.separable) d.t = d.forms.sum({d.t, momentum});
    }
    std::vector<Derivation::Output> of_gradient;
    std::vector<Derivation::Output> of_force;
    std::vector<Derivation::Output> of_velocity;
    std::vector<int> by_q;
    std::vector<int> by_p;
    for (std::size_t i = 0; i < degrees(); ++i) by_q.push_back(d.derivative(d.v >= 0 ? d.v : d.h, position_symbol(i)));
    for (std::size_t i = 0; i < degrees(); ++i) by_p.push_back(d.derivative(d.t >= 0 ? d.t : d.h, momentum_symbol(i)));
    for (const int form : by_q) of_gradient.push_back({form});
    for (const int form : by_p) of_gradient.push_back({form});
    gradient = d.code(of_gradient);
    if (structure_.separable) {
      energy = d.code_of_sum(d.t, d.v);
      kinetic = d.code({{d.t}});
      potential = d.code({{d.v}});
      for (const int form : by_p) of_velocity.push_back({form});
      for (const int form : by_q) of_force.push_back({form, true});
      velocity = d.code(of_velocity);
      force = d.code(of_force);
      structure_.quadratic_kinetic = true;
      for (std::size_t i = 0; i < n && structure_.quadratic_kinetic; ++i) {
        bool any = false;  // stays false for a row of zeros, which makes M singular
        for (std::size_t j = 0; j < n; ++j) any = any || !d.forms.is_zero(d.derivative(by_p[i], n + j));
        structure_.quadratic_kinetic = any && is_linear(d.forms, by_p[i], n);
      }
      if (n > 1 && structure_.quadratic_kinetic && !structure_.time && is_one_scalar(d.forms, by_q, 0) &&
          is_one_scalar(d.forms, by_p, n)) {
        for (auto& o : of_force) o.scale = static_cast<int>(factor_symbol());
        for (auto& o : of_velocity) o.scale = static_cast<int>(factor_symbol());
        scaled_force = d.code(of_force);
        scaled_velocity = d.code(of_velocity);
      }
    } else {
      energy = d.code({{d.h}});
    }
  } catch (const FormulaError&) {
    throw;
  } catch (const Error& error) {
    throw FormulaError(key, error.what());
  }
  std::vector<int> values;
  for (std::size_t k = first_invariant; k < first_constraint; ++k) values.push_back(roots[k]);
  invariant_values = std::make_shared<const Code>(code_of(graph, values, fixed));
  if (structure_.constraints > 0) {
    derive_constraints({roots.begin() + static_cast<std::ptrdiff_t>(first_constraint), roots.end()});
  }
}

void Model::derive_constraints(const std::vector<int>& values) {
  Derivation& d = *derivation_;
  const std::size_t n = size();
  if (!structure_.quadratic_kinetic) {
    throw FormulaError(FormulaKeys::constraints,
                       "found constraints with an H that is not p^T M^-1 p/2 + V(q) with constant M; allowed such an "
                       "H, or no constraints");
  }
  std::vector<Derivation::Output> of_gradients;
  std::vector<Derivation::Output> curvatures;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::string key = std::string(FormulaKeys::constraints) + "[" + std::to_string(k) + "]";
    try {
      const int g = d.forms.of_node(values[k]);
      for (std::size_t i = n; i <= 2 * n; ++i) {
        if (!d.forms.depends(g, static_cast<int>(i))) continue;
        throw FormulaError(key, "found " + symbols_.names[i] + " in it; allowed coordinates and parameters");
      }
      std::vector<int> curvature;
      bool any = false;
      for (std::size_t i = 0; i < n; ++i) {
        const int by = d.derivative(g, position_symbol(i));
        any = any || !d.forms.is_zero(by);
        of_gradients.push_back({by});
        for (std::size_t j = 0; j < n; ++j) {
          const int second = d.derivative(by, position_symbol(j));
          if (d.forms.is_zero(second)) continue;
          curvature.push_back(d.forms.product(second, d.forms.product(d.symbol(n + i), d.symbol(n + j))));
        }
      }
      for (std::size_t i = n; i < degrees(); ++i) of_gradients.push_back({d.forms.sum({})});
      if (!any)
        throw FormulaError(key,
                           "found no coordinate in it; allowed a function of coordinates that the motion keeps at 0");
      curvatures.push_back({d.forms.sum(curvature)});
    } catch (const FormulaError&) {
      throw;
    } catch (const Error& error) {
      throw FormulaError(key, error.what());
    }
  }
  constraints = std::make_shared<const Code>(code_of(d.graph, values, d.fixed));
  constraint_gradients = d.code(of_gradients);
  constraint_curvatures = d.code(curvatures);
}

const HessianCode& Model::hessian() const {
  const std::scoped_lock lock(mutex_);
  if (hessian_) return *hessian_;
  Derivation& d = *derivation_;
  const std::size_t n = degrees();
  auto all = std::make_unique<HessianCode>();
  std::vector<Derivation::Output> outputs;
  const auto add = [&](Entries& entries, const auto& row_symbol, const auto& column_symbol, bool symmetric) {
    for (std::size_t i = 0; i < n; ++i) {
      const int row = d.derivative(d.h, row_symbol(i));
      for (std::size_t j = symmetric ? i : 0; j < n; ++j) {
        const int entry = d.derivative(row, column_symbol(j));
        if (d.forms.is_zero(entry)) continue;
        entries.emplace_back(i, j);
        outputs.push_back({entry});
      }
    }
  };
  const auto position = [this](std::size_t i) { return position_symbol(i); };
  const auto momentum = [this](std::size_t i) { return momentum_symbol(i); };
  add(all->qq, position, position, true);
  add(all->qp, position, momentum, false);
  add(all->pp, momentum, momentum, true);
  all->code = d.code(outputs);
  hessian_ = std::move(all);
  return *hessian_;
}

const ForceAndHessianCode& Model::force_and_hessian() const {
  const std::scoped_lock lock(mutex_);
  if (force_and_hessian_) return *force_and_hessian_;
  Derivation& d = *derivation_;
  const std::size_t n = degrees();
  auto all = std::make_unique<ForceAndHessianCode>();
  std::vector<Derivation::Output> outputs;
  for (std::size_t i = 0; i < n; ++i) outputs.push_back({d.derivative(d.v, position_symbol(i)), true});
  for (std::size_t i = 0; i < n; ++i) {
    const int row = d.derivative(d.v, position_symbol(i));
    for (std::size_t j = i; j < n; ++j) {
      const int entry = d.derivative(row, position_symbol(j));
      if (d.forms.is_zero(entry)) continue;
      all->entries.emplace_back(i, j);
      outputs.push_back({entry});
    }
  }
  all->code = d.code(outputs);
  force_and_hessian_ = std::move(all);
  return *force_and_hessian_;
}

}  // namespace hamflow::formula
