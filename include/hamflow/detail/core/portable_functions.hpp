// Elementary functions with the same bits on every processor and with every compiler. They use + - * / sqrt of doubles
// and operations on whole numbers, nothing of the C library's functions, and no fused multiply-add.
// The error is below 0.501 units in the last place; tests/reference/portable_functions_accuracy_test.cpp measures it.
// Zeros, infinities, NaN and signs are those of Annex F of the C standard. The rounding mode has to be "to nearest".
// A result that is no number is always the same NaN, whatever the payload of an argument.
#pragma once

namespace hamflow::portable {

double exp(double x);
double log(double x);
double sin(double x);
double cos(double x);
double tan(double x);
double asin(double x);
double acos(double x);
double atan(double x);
double sinh(double x);
double cosh(double x);
double tanh(double x);
/// The angle of the point (x, y), from -pi to pi.
double atan2(double y, double x);
/// x^y
double pow(double x, double y);
/// sqrt(x^2 + y^2)
double hypot(double x, double y);

}  // namespace hamflow::portable
