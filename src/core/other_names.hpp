// Names that other programs and texts use for methods, arithmetics, problems, potentials, scenario keys and options.
// Each line is "name in hamflow: other name, ...", in lower case, with '-' between words.
#pragma once

#include <string_view>

namespace hamflow {

inline constexpr std::string_view other_names = R"(
verlet: leapfrog, leap-frog, stoermer-verlet, stormer-verlet, velocity-verlet, strang, symplectic2
verlet-dkd: position-verlet
stv4: yoshida, yoshida4, forest-ruth, symplectic4, ruth4
euler-a: symplectic-euler, semi-implicit-euler, symplectic1
euler: explicit-euler, forward-euler
rk4: runge-kutta
dop853: rk8, dopri, dopri5, dopri8
cg: hbvm, hamiltonian-boundary-value
discrete-gradient: gonzalez
eg: energy-momentum, labudde-greenspan
lobatto-3a-3b: lobatto, lobatto-iiia-iiib, generalized-leapfrog, generalised-leapfrog, generalized-stoermer-verlet
avf: averaged-vector-field
gauss: gauss-legendre, collocation, irk
implicit-midpoint: midpoint, midpoint-rule
double: float64
double-double: dd, long-double
quad: quadruple, float128
mp(d): mpfr
compensated: kahan
lattice: integer, fixed-point
central-force: two-body, 2-body
n-body: three-body, 3-body, gravity
solar-system: planets
harmonic: harmonic-oscillator
fput: fermi-pasta-ulam
kepler: newton, coulomb, gravitational
hooke: spring
dt: h, step-size, stepsize, timestep, time-step
t_end: t, tmax, t-max, tstop, t-stop, t-final
arithmetic: precision
degree: order
mass: m
quit: exit, bye
--out: -o
--force: -f
--quiet: -q
)";

}  // namespace hamflow
