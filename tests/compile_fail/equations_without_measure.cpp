// expect: equations of a step need last_state()
#include "hamflow/hamflow.hpp"

using Problem = hamflow::HenonHeiles<double>;

struct Unmeasured : hamflow::NaturalElement<Problem, double> {
  using NaturalElement::NaturalElement;
  void measure();
};

void misuse() {
  hamflow::ImplicitMethod<Problem, hamflow::Compensated<double>, Unmeasured> method(Problem(), hamflow::CgOptions{});
  (void)method;
}
