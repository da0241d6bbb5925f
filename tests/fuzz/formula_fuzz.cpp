// libFuzzer on typed formulas: any text is either refused with a message, or read, evaluated and differentiated.
// ./dev fuzz builds and runs it.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "hamflow/detail/formula/bound_model.hpp"

namespace {

const hamflow::FormulaSymbols symbols{.names = {"x", "y", "p_x", "p_y", "t", "k", "n", "m[1]", "m[2]", "q.a[0]"},
                                      .known = {{"k", 0.5}, {"n", 3}, {"m[1]", 1}, {"m[2]", 2}}};

void expect(bool holds) {
  if (!holds) std::abort();
}

/// Every message has the three parts by which a person finds the place.
void expect_message(const std::string& message) {
  expect(message.find("found ") != std::string::npos && message.find("; allowed ") != std::string::npos);
}

void read(const std::string& text) {
  try {
    const hamflow::Formula f = hamflow::parse_formula(text, symbols);
    const std::vector<double> at{0.3, -0.7, 1.1, 0.4, 2, 0.5, 3, 1, 2, 5};
    (void)f.evaluate<double>(at);
    using D = hamflow::Dual<double, 2>;
    std::vector<D> dual(at.begin(), at.end());
    dual[0] = D::variable(0.3, 0);
    (void)f.evaluate<D>(dual);
  } catch (const hamflow::Error& error) {
    expect_message(error.what());
    expect(std::string(error.what()).find("column ") != std::string::npos);
  }
}

/// As a Hamiltonian, with all its derivatives. Short texts: that they cannot take long is what limits are for.
void differentiate(const std::string& text) {
  if (text.size() > 200) return;
  try {
    const hamflow::FormulaTexts texts{
        .coordinates = {"x", "y"}, .hamiltonian = text, .parameters = {{"k", "0.5"}, {"n", "3"}, {"m", "[1, 2]"}}};
    const auto model = std::make_shared<const hamflow::formula::Model>(texts);
    const hamflow::formula::BoundModel<double> bound(model, hamflow::Parameters<double>(texts.parameters));
    const std::size_t n = model->degrees();  // the time is one, where H depends on it
    hamflow::Vector<double, hamflow::dynamic> q(n);
    hamflow::Vector<double, hamflow::dynamic> p(n);
    q[0] = 0.3;
    q[1] = -0.7;
    p[0] = 1.1;
    p[1] = 0.4;
    hamflow::Vector<double, hamflow::dynamic> a(n);
    hamflow::Vector<double, hamflow::dynamic> b(n);
    bound.gradient(q, p, a, b);
    hamflow::Matrix<double, hamflow::dynamic> qq(n);
    hamflow::Matrix<double, hamflow::dynamic> qp(n);
    hamflow::Matrix<double, hamflow::dynamic> pp(n);
    bound.hessian(q, p, qq, qp, pp);
    if (model->structure().separable) bound.force_and_hessian(q, a, qq);
  } catch (const hamflow::Error& error) {
    expect_message(error.what());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  read(text);
  differentiate(text);
  return 0;
}
