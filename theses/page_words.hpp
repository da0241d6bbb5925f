// What the page says before its experiments: which theses they are of, and the words that claims are told in.
#pragma once

#include <string>

namespace hamflow::reproduction {

/// Of the thesis with that name: author, title, what it is, where and when; HTML.
inline std::string source_of(const std::string& thesis) {
  if (thesis == "Gross") {
    return "Michael Gro&szlig;, <cite lang=\"de\">Numerische Untersuchungen diskreter dynamischer Systeme im Rahmen "
           "der "
           "PETROV-GALERKIN-Methode</cite>, Studienarbeit S02/99, <span lang=\"de\">Lehrstuhl f&uuml;r Technische "
           "Mechanik, Universit&auml;t Kaiserslautern</span>, 1999. Finite elements in time that keep the energy, "
           "for bodies under a central force and for the double pendulum.";
  }
  return "Klaus Sonnleitner, <cite lang=\"de\">StV4: Ein symplektisches zeitreversibles St&ouml;rmer-Verlet-Verfahren "
         "vierter Ordnung f&uuml;r Hamiltonsche Mehrteilchensysteme mit zwei Anwendungsbeispielen (Gas, "
         "T-Rohr-Anordnung)</cite>, dissertation, <span lang=\"de\">Eberhard Karls Universit&auml;t "
         "T&uuml;bingen</span>, "
         "2010. An explicit method of order 4, for a gas in a circle and for two bodies in the tubes of a T.";
}

struct Word {
  const char* word;
  const char* meaning;  // HTML
};

inline constexpr Word glossary[] = {
    {"H, dt", "the Hamiltonian, which is the energy; the length of a step in time"},
    {"cg(k, m)",
     "the element of Gro&szlig;: Petrov-Galerkin in time, of degree k and order 2k, its integrals by Gauss' "
     "quadrature with m points, &ldquo;auto&rdquo; as many as keep H to rounding; implicit"},
    {"eg(k)", "an element of Gro&szlig;, Betsch and Steinmann, of 2005, which keeps the angular momentum, too"},
    {"euler-a",
     "EulerA of Sonnleitner, page 34: the symplectic Euler method that moves first and kicks afterwards; "
     "order 1"},
    {"verlet", "St&ouml;rmer-Verlet, kicks first; order 2. verlet-dkd moves first: the variant of page 53"},
    {"stv4", "StV4 of Sonnleitner: three steps of St&ouml;rmer-Verlet, of which the middle one goes back; order 4"},
    {"rk4, rkn8-s19, dop853, taylor",
     "Runge-Kutta's classical method, order 4; a symplectic method of order 8 with 19 forces a step (2022); Dormand "
     "and Prince's of order 8; Taylor series of the motion: the last three are what others are compared with"},
    {"wall rules",
     "what happens where a body meets a wall. <em>reject</em>, the thesis': a step that would leave is not "
     "taken, and the momentum is negated. <em>mirror</em>: the motion goes on as its mirror image. "
     "<em>event</em>: the time of the bounce is located. <em>soft</em>: a force that grows towards the "
     "wall"},
    {"scale",
     "of the gas: the length of its potential. <em>per-side</em>, as it is meant: neighbours start one such "
     "length apart. <em>listing</em>, as it is programmed: with the number of particles in place of the "
     "number on a side"},
    {"arithmetics",
     "<em>double</em>: 16 digits. <em>compensated</em>: what sums lose to rounding is carried on. "
     "<em>double-double</em>: 32 digits. <em>lattice</em>: positions and momenta are whole numbers, so that "
     "a reversible method returns to the last bit"},
    {"criterion &ldquo;seed&rdquo;",
     "an implicit step ends as in the thesis' programs, at a residual below an absolute "
     "tolerance of 1e-13; elsewhere where rounding lets it become no smaller"},
    {"-0.6I, +0.6III, ...",
     "starts of the T-tube, as the table of Sonnleitner's pages 99 and 100 names them: the strength eps of the force, "
     "which attracts where it is positive, and a number for the velocities (light body, heavy body): repelling (0, 1) "
     "for "
     "I, (6, 1) for III, (10, 1) for IV; attracting (0, 1) for I, (1, 1) for III, (6, 1) for IV"},
    {"late -0.6I-2",
     "the motion from a start within 1e-8 of that one, behind 12 million steps in which the rule reject "
     "has made "
     "it regular; -2 is the second such motion that was found"},
    {"digits lost", "there and back: log10 of the relative distance from the start over a unit of rounding"}};

}  // namespace hamflow::reproduction
