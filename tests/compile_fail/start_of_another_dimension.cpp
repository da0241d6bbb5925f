// expect: a start needs as many coordinates and as many momenta as the problem has degrees of freedom
#include "hamflow/hamflow.hpp"

void misuse() { (void)hamflow::simulate(hamflow::HenonHeiles<double>(), hamflow::Cg{}, {1.0}, {0.1, 0.1}, 0.1); }
