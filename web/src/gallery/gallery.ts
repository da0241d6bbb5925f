// Scenarios to begin with, each with what to look at and a question.

export interface Entry {
  title: string;
  look: string;
  question: string;
  x: string;
  y: string;
  equal: boolean;
  toml: string;
}

export const gallery: Entry[] = [
  {
    title: "Henon-Heiles",
    look: "A star in a potential with three exits. At this energy some orbits are regular and some chaotic. The energy error of a symplectic method stays bounded.",
    question: "What happens to the orbit if the start moves by a thousandth?",
    x: "x",
    y: "y",
    equal: true,
    toml: `[problem]
name = "formula"
coordinates = ["x", "y"]
hamiltonian = "(p_x^2 + p_y^2)/2 + (x^2 + y^2)/2 + x^2*y - y^3/3"
initial = { q = [0, 0.1], p = [0.45, 0.1] }

[method]
name = "stv4"

[run]
dt = 0.05
steps = 20000
`,
  },
];
