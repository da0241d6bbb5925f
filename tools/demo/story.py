"""The story of the demo: six promises of hamflow, each shown by commands that anybody can run again.

Commands stand as they can be copied, with the folders that ./dev demo uses."""

import dataclasses

KEPLER = "examples/kepler_ellipse.toml"
LONG = "--set run.dt=0.25 --set run.steps=1e6 --set run.record_every=97 --set 'output.figures=[]'"
ATWOOD = "examples/formulas/swinging_atwood.toml"
CHAOS = "examples/henon_heiles.toml --set 'problem.initial={q=[0,-0.15],p=[0.54,0.1]}'"


@dataclasses.dataclass
class Figure:
    caption: str
    commands: list[str]
    image: str = ""  # in the report; without one what the last command prints is shown


@dataclasses.dataclass
class Chapter:
    title: str
    text: str
    figures: list[Figure]
    alone: bool = False  # run when nothing else is: what measures time


STORY = [
    Chapter("An ellipse on its conic",
            "A planet goes round 10^4 times, about 100 steps each, by a symplectic method of order 8. The line is the conic that Kepler promised, the "
            "dots are computed, from the first revolution to the last.",
            [Figure("computed (dots) and exact (line)",
                    [f"build/release/hamflow run {KEPLER} --set method.name=kahan-li8 {LONG} --force --out build/demo/ellipse.run",
                     "build/release/hamflow plot build/demo/ellipse.run --kind orbit -o build/demo/orbit.svg"], "orbit.svg"),
             Figure("energy error, relative", ["build/release/hamflow plot build/demo/ellipse.run --kind energy-error -o build/demo/kept.svg"], "kept.svg")]),
    Chapter("Energy lost and kept",
            "The same ellipse by two methods of order 4. The classical Runge-Kutta method loses a little energy in each step, and "
            "the orbit shrinks; the symplectic one oscillates about the right energy as long as one looks.",
            [Figure("rk4: lost", [f"build/release/hamflow run {KEPLER} --set method.name=rk4 {LONG} --force --out build/demo/rk4.run",
                                  "build/release/hamflow plot build/demo/rk4.run --kind energy-error -o build/demo/lost.svg"], "lost.svg"),
             Figure("stv4: kept", [f"build/release/hamflow run {KEPLER} --set method.name=stv4 {LONG} --force --out build/demo/stv4.run",
                                   "build/release/hamflow plot build/demo/stv4.run --kind energy-error -o build/demo/bounded.svg"], "bounded.svg")]),
    Chapter("Bits that come back",
            "On a lattice of integers a symmetric splitting is one-to-one: 10^7 steps forward, the momenta negated, 10^7 steps again, and "
            "every bit is where it was. In floating point it is not.",
            [Figure("on the lattice", [f"build/release/hamflow reverse {KEPLER} --set method.name=stv4 --set run.arithmetic=lattice --set run.steps=1e7 --quiet"]),
             Figure("in double", [f"build/release/hamflow reverse {KEPLER} --set method.name=stv4 --set run.steps=1e7 --quiet"])]),
    Chapter("A chaotic map",
            "Stars in a galaxy, after Henon and Heiles. One orbit wanders through a sea of points; the map beside it shows for 7371 starts at rest how fast "
            "neighbours part, the largest Lyapunov exponent: dark is chaos, light is order, white starts leave for ever.",
            [Figure("one orbit, where it crosses q1 = 0",
                    [f"build/release/hamflow run {CHAOS} --set 'run.section={{coordinate=\"q1\"}}' --set run.steps=200000 --set 'output.figures=[]' --force --out build/demo/chaos.run",
                     "build/release/hamflow plot build/demo/chaos.run --kind section -o build/demo/section.svg"], "section.svg"),
             Figure("largest Lyapunov exponent of 7371 starts at rest",
                    ["build/release/hamflow sweep examples/henon_heiles.toml --set 'problem.initial={q=[0,0],p=[0,0]}' "
                     "--vary 'problem.initial.q[0]=-0.9:0.9:91' --vary 'problem.initial.q[1]=-0.55:1.05:81' --set run.steps=4000 "
                     "--set run.lyapunov=1 --force --out build/demo/chaos.sweep --quiet --figure build/demo/map.svg --colour observables/lyapunov1"],
                    "map.svg")]),
    Chapter("A Hamiltonian that you type",
            "Two weights on one rope over two pulleys; one of them swings. Its Hamiltonian is a line of text in the scenario; it is not separable, so that "
            "an element integrates it and keeps its energy. At this ratio of masses, 3, the motion is integrable: the path winds about a torus.",
            [Figure("the path of the swinging weight",
                    [f"build/release/hamflow run {ATWOOD} --set 'output.observables={{x=\"r*sin(theta)\",y=\"-r*cos(theta)\"}}' --force --out build/demo/atwood.run",
                     "build/release/hamflow plot build/demo/atwood.run --kind time --x x --y y -o build/demo/atwood.svg"], "atwood.svg"),
             Figure("energy error, relative", ["build/release/hamflow plot build/demo/atwood.run --kind energy-error -o build/demo/atwood_energy.svg"],
                    "atwood_energy.svg")]),
    Chapter("As fast as a loop by hand",
            "Problem, method and arithmetic are types, so that the compiler sees one loop. Measured just now, in turns, the best of 400: "
            "Stoermer-Verlet on the ellipse, which end at the same bits.",
            [Figure("a step of 0.1", ["build/release/examples/example_hand_loop"])], alone=True),
]
