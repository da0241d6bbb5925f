// Formulas of numbers in the arithmetics with more digits, compiled once.
#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"

namespace hamflow {

template DoubleDouble evaluate_number<DoubleDouble>(std::string_view);
template Quad evaluate_number<Quad>(std::string_view);
template Mp evaluate_number<Mp>(std::string_view);

}  // namespace hamflow
