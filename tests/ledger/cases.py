"""The cases of the ledger: invocations of every command, short enough that all of them take seconds."""

import dataclasses
import typing

SCENARIOS = {
    "kepler": '[problem]\nname = "central-force"\npotential = "kepler"\nmass = 2\n'
              'orbit = { kind = "ellipse", r_per = 1, r_aph = 3 }\n[method]\nname = "cg"\nquadrature = 5\n'
              '[run]\ndt = 0.1\nsteps = 300\n',
    "pendulum": '[problem]\nname = "pendulum"\ninitial = { q = [2.5], p = [0] }\n[method]\nname = "verlet"\n'
                '[run]\ndt = 0.1\nt_end = 20\n',
    "spherical": '[problem]\nname = "pendulum"\ncoordinates = "cartesian"\ndimension = 3\n'
                 'initial = { q = [0.6, 0, -0.8], v = [0.4, 0.9, 0.3] }\n[method]\nname = "rattle4"\n'
                 '[run]\ndt = 0.05\nsteps = 200\n',
    "double": '[problem]\nname = "double-pendulum"\nmodel = "nonlinear"\nmasses = [2, 2]\nhalf_lengths = [3, 3]\n'
              'initial = { q = [0, "pi/2"], p = [0, 0] }\n[method]\nname = "cg"\nquadrature = 5\ndiagnostics = true\n'
              '[run]\ndt = 0.01\nsteps = 200\n',
    "duffing": '[problem]\nname = "duffing"\nmass = 2\ncase = 1\nk = 1\nr0 = 4\nspeed = 4\n[method]\nname = "gauss"\n'
               '[run]\ndt = 0.05\nsteps = 200\n',
    "henon": '[problem]\nname = "henon-heiles"\ninitial = { q = [0.18, 0.18], p = [0.18, 0.18] }\n[method]\nname = "stv4"\n'
             '[run]\ndt = 0.1\nsteps = 3000\n',
    "oscillator": '[problem]\nname = "lennard-jones-oscillator"\n[method]\nname = "stv4"\n[run]\ndt = 0.01\nsteps = 1000\n',
    "harmonic": '[problem]\nname = "harmonic"\nomega = 1.3\ninitial = { q = [1], p = [0] }\n[method]\nname = "verlet"\n'
                '[run]\ndt = 0.05\nsteps = 400\n',
    "fall": '[problem]\nname = "free-fall"\ngravity = 9.81\nwalls = [{ coordinate = "q", min = -1 }]\n'
            'initial = { q = [0], p = [0] }\n[method]\nname = "cg"\n[run]\ndt = 0.01\nsteps = 1000\n',
    "sextic": '[problem]\nname = "sextic"\ninitial = { q = [0.5], p = [1.2] }\n[method]\nname = "avf"\n[run]\ndt = 0.05\nsteps = 200\n',
    "fput": '[problem]\nname = "fput"\nn = 4\nalpha = 0.25\ninitial = { q = [0.1, 0.3, 0.2, 0.4], p = [0, 0, 0, 0] }\n'
            '[method]\nname = "stv4"\n[run]\ndt = 0.1\nsteps = 500\n',
    "eight": '[problem]\nname = "n-body"\nmasses = [1, 1, 1]\ninitial = { q = [0.97000436, -0.24308753, -0.97000436, 0.24308753, 0, 0], '
             'p = [0.466203685, 0.43236573, 0.466203685, 0.43236573, -0.93240737, -0.86473146] }\n[method]\nname = "yoshida6"\n'
             '[run]\ndt = 0.01\nsteps = 600\n',
    "solar": '[problem]\nname = "solar-system"\n[method]\nname = "stv4"\n[run]\ndt = 50\nsteps = 300\n',
    "magnetic": '[problem]\nname = "magnetic"\nfield = [0, 0, 1]\ninitial = { q = [1, 0, 0], v = [0, 1, 0.1] }\n'
                '[method]\nname = "boris"\n[run]\ndt = 0.05\nsteps = 300\n',
    "tube": '[problem]\nname = "t-tube"\nmasses = [1, 100]\neps = -0.6\nvelocities = [6, 1]\nwall_rule = "event"\n[method]\n'
            'name = "cg"\ndegree = 2\n[run]\ndt = 0.01\nsteps = 500\n',
    "gas": '[problem]\nname = "gas"\nparticles_per_side = 4\nstart = "lattice"\nseed = 1\npair = "lennard-jones"\n'
           'container = { kind = "circle", radius = 1.5, exponent = 1 }\n[method]\nname = "stv4"\n'
           '[run]\ndt = 0.0001\nsteps = 100\nrecord_every = 10\n',
    "box": '[problem]\nname = "gas"\nparticles_per_side = 4\nstart = "lattice"\nseed = 3\npair = "lennard-jones"\n'
           'container = { kind = "periodic", size = [3, 3] }\ncutoff = { radius = 1.2, kind = "shifted" }\n[method]\n'
           'name = "verlet"\n[run]\ndt = 0.0001\nsteps = 100\nrecord_every = 10\n',
    "formula": '[problem]\nname = "formula"\ncoordinates = ["x", "y"]\n'
               'hamiltonian = "(p_x^2 + p_y^2)/2 + x^2/2 + y^2 + a*x^2*y"\nparameters = { a = 0.3 }\n'
               'invariants = { e = "p_x^2/2 + p_y^2/2" }\ninitial = { q = [0.3, 0.2], p = [0.1, 0.4] }\n[method]\n'
               'name = "stv4"\n[run]\ndt = 0.05\nsteps = 400\n',
    "driven": '[problem]\nname = "formula"\ncoordinates = ["x"]\nhamiltonian = "p_x^2/2 - x*cos(t)"\n'
              'initial = { q = [0], p = [0] }\n[method]\nname = "rk4"\n[run]\ndt = 0.01\nsteps = 500\n',
    "coupled": '[problem]\nname = "formula"\ncoordinates = ["x"]\nhamiltonian = "p_x^2*(1 + x^2/5)/2 + x^4/4"\n'
               'initial = { q = [1], p = [0.5] }\n[method]\nname = "tao4"\n[run]\ndt = 0.01\nsteps = 400\n',
    "map": '[problem]\nname = "formula"\ncoordinates = ["q"]\nhamiltonian = "p^2/2 + K*cos(q)"\nparameters = { K = 1.2 }\n'
           'initial = { q = [3], p = [0.4] }\n[method]\nname = "euler-b"\n[run]\ndt = 1\nsteps = 500\nmap = true\nsection = {}\n'
           'lyapunov = 1\n',
    "runaway": '[problem]\nname = "formula"\ncoordinates = ["q"]\nhamiltonian = "p^2/2 - q^4/4"\n'
               'initial = { q = [1], p = [1] }\n[method]\nname = "verlet"\n[run]\ndt = 0.5\nsteps = 500\n',
    "collapse": '[problem]\nname = "formula"\ncoordinates = ["q"]\nhamiltonian = "p^2/2 - 1/abs(q)"\n'
                'initial = { q = [1], p = [0] }\n[method]\nname = "gauss"\n[run]\ndt = 0.2\nsteps = 500\n',
    "plane": '[problem]\nname = "central-force"\npotential = "power"\na = ["1/3", -0.5]\nn = [2, -1.5]\n'
             'orbit = { energy = 1.5, angular_momentum = 0.6 }\n[method]\nname = "stv4"\n[run]\ndt = 0.01\nsteps = 500\n',
    "typed": '[problem]\nname = "central-force"\npotential = "formula"\nV = "-k/r + b/r^2"\nparameters = { k = 1, b = 0.02 }\n'
             'initial = { q = [1, 0], p = [0, 0.9] }\n[method]\nname = "verlet"\n[run]\ndt = 0.01\nsteps = 500\n',
    "pair": '[problem]\nname = "central-force"\npotential = "kepler"\nbodies = [{ mass = 1, position = [0, 0, 0], velocity = [0, 0, 0] }, '
            '{ mass = 0.5, position = [1, 0, 0.2], velocity = [0, 1, 0.1] }]\n[method]\nname = "verlet"\n[run]\ndt = 0.01\nsteps = 200\n',
}

# Whole files that the cases read besides, by what they are for.
PARTICLES = "x,y,p_x,p_y,mass\n0.1,0.2,0.3,0,1\n1.4,0.1,0,0.2,2\n0.3,1.5,-0.1,0,1\n"


@dataclasses.dataclass
class Case:
    scenario: str
    commands: list  # each (arguments, text on the standard input or None)
    more: dict = dataclasses.field(default_factory=dict)

    def files(self):
        return {"s.toml": SCENARIOS[self.scenario], **self.more}


CASES: dict[str, Case] = {}


def case(name, scenario, *commands, more: typing.Optional[dict] = None):
    """A case of one or more commands, each a text whose words are parted by blanks; '~' stands for a blank in a word."""
    assert name not in CASES, name
    taken = []
    for command in commands:
        text, _, typed = command.partition("<<<")
        taken.append(([word.replace("~", " ") for word in text.split()], typed.replace(";", "\n").strip() + "\n" if typed else None))
    CASES[name] = Case(scenario, taken, more or {})


def sets(*keys):
    return "".join(f" --set {key}" for key in keys)


# run: every problem with its own method, as JSON and as a folder.
for scenario in SCENARIOS:
    case(f"run/{scenario}", scenario, "run s.toml --json --quiet --out r" + sets('output.formats=["h5","csv"]'))

# run: every family of methods.
for method in ("verlet", "stv4", "kahan-li8", "yoshida6", "euler-a", "chin4a", "blanes-moan-s10", "rk4", "dop853", "taylor", "gauss(3)",
               "lobatto-3a-3b(3)", "implicit-midpoint", "cg(2,6)", "eg(2)", "avf(4)", "discrete-gradient", "itoh-abe"):
    case(f"method/{method}", "henon", f"run s.toml --json --quiet --out none --set run.steps=200 --set method.name={method}")
for method in ("tao2", "tao4(40)", "gauss(2)", "cg(1,8)", "rk4"):
    case(f"method/coupled/{method}", "coupled", f"run s.toml --json --quiet --out none --set method.name={method}")

# run: every arithmetic.
for arithmetic in ("compensated", "double-double", "quad", "mp(40)", "lattice"):
    for scenario, method in (("henon", "stv4"), ("oscillator", "verlet")):
        case(f"arithmetic/{arithmetic}/{scenario}", scenario, "run s.toml --json --quiet --out r" +
             sets("run.steps=100", f"run.arithmetic={arithmetic}", f"method.name={method}", 'output.formats=["h5","csv"]'))
for arithmetic in ("compensated", "double-double", "mp(30)"):
    case(f"arithmetic/{arithmetic}/kepler", "kepler", "run s.toml --json --quiet --out r" +
         sets("run.steps=50", f"run.arithmetic={arithmetic}"))

# run: what is recorded and measured besides.
case("record/every", "henon", "run s.toml --json --quiet --out r --set run.steps=500 --set run.record_every=7")
case("record/times", "henon", "run s.toml --json --quiet --out r --set run.steps=500 --set run.record=[0,0.25,3,20.01]")
case("record/observables", "henon", "run s.toml --json --quiet --out r" +
     sets("run.steps=500", "output.observables={r2=\"q1^2~+~q2^2\",pp=\"p1*p2\"}", 'output.formats=["h5","csv"]'))
case("record/section", "henon", "run s.toml --json --quiet --out r" + sets("run.section={coordinate=\"q1\"}"))
case("record/section_expression", "henon", "run s.toml --json --quiet --out r" +
     sets("run.section={expression=\"q1+q2\",value=0.1,direction=0}"))
case("record/events", "kepler", "run s.toml --json --quiet --out r" +
     sets("run.events=[{name=\"down\",expression=\"x\",direction=-1},{expression=\"y-0.5\",direction=0}]"))
case("record/stop", "kepler", "run s.toml --json --quiet --out r" +
     sets("run.events=[{name=\"down\",expression=\"x\",action=\"stop\"}]"))
case("record/section_mp", "henon", "run s.toml --json --quiet --out r" +
     sets("run.steps=300", "run.arithmetic=mp(40)", "run.section={coordinate=\"q1\"}"))
case("record/few_events", "fall", "run s.toml --json --quiet --out r --set run.record_events=2")
case("measure/lyapunov", "henon", "run s.toml --json --quiet --out r --set run.lyapunov=4")
case("measure/eigenvalues", "henon", "run s.toml --json --quiet --out r --set run.steps=63 --set run.eigenvalues=true")
case("measure/section_lyapunov", "henon", "run s.toml --json --quiet --out r" + sets("run.lyapunov=1", "run.section={coordinate=\"q1\"}"))
case("measure/step_control", "kepler", "run s.toml --json --quiet --out r" +
     sets("method={name=\"stv4\",step_control=\"reversible\"}", "run.dt=0.01"))
case("measure/monitor", "kepler", "run s.toml --json --quiet --out r" +
     sets("method={name=\"stv4\",step_control=\"reversible\",monitor=\"distance\"}", "run.dt=0.01"))
case("measure/backward", "kepler", "run s.toml --json --quiet --out none --set run.dt=-0.1")
case("measure/no_steps", "kepler", "run s.toml --json --quiet --out r --set run.steps=0")
case("measure/fixed_point", "duffing", "run s.toml --json --quiet --out none --set method.iteration=fixed-point")
case("measure/simplified", "duffing", "run s.toml --json --quiet --out none --set method.iteration=simplified")
case("measure/seed", "kepler", "run s.toml --json --quiet --out none --set method.criterion=seed")
case("measure/diagnostics", "kepler", "run s.toml --json --quiet --out r --set method.diagnostics=true")
case("measure/figures", "kepler", "run s.toml --json --quiet --out r --set output.figures=[\"orbit\",\"energy-error\"]")

# Walls.
for rule in ("event", "mirror", "reject"):
    case(f"walls/{rule}", "fall", f"run s.toml --json --quiet --out r --set problem.wall_rule={rule} --set method.name=verlet" +
         sets("method.quadrature=0")[:0])
case("walls/soft", "henon", "run s.toml --json --quiet --out r" +
     sets("run.steps=300", "problem.walls=[{coordinate=\"q1\",min=-0.2,max=0.2}]", "problem.wall_rule=soft", "problem.strength=100"))
case("walls/two", "henon", "run s.toml --json --quiet --out r" + sets("run.steps=300", "problem.walls=[{coordinate=\"q1\",min=-0.2,max=0.2}]"))
case("walls/lyapunov", "henon", "run s.toml --json --quiet --out none" +
     sets("run.steps=300", "problem.walls=[{coordinate=\"q1\",min=-0.2,max=0.2}]", "run.lyapunov=1"))
case("walls/tube_stv4", "tube", "run s.toml --json --quiet --out r --set method={name=\"stv4\"} --set problem.wall_rule=reject")

# Gases.
case("gas/corner", "gas", "run s.toml --json --quiet --out r --set problem.start=corner --set run.arithmetic=lattice")
case("gas/threads", "box", "run s.toml --json --quiet --out none --set run.arithmetic=lattice --set run.threads=2")
case("gas/space", "gas", "run s.toml --json --quiet --out r" +
     sets("problem.dimension=3", "problem.particles_per_side=3", "run.steps=20", "problem.container.radius=2"))
case("gas/file", "gas", "run s.toml --json --quiet --out r" +
     sets("problem={name=\"gas\",start=\"file\",file=\"particles.csv\",pair=\"newton\",softening=0.1,container={kind=\"none\"}}", "run.dt=0.01"),
     more={"particles.csv": PARTICLES})
case("gas/formula", "gas", "run s.toml --json --quiet --out none" +
     sets("problem={name=\"gas\",start=\"file\",file=\"particles.csv\",pair=\"formula\",phi=\"A*exp(-r)\",parameters={A=2},container={kind=\"none\"}}",
          "run.dt=0.01"), more={"particles.csv": PARTICLES})
case("gas/again", "gas", "run s.toml --quiet --out r", "run s.toml --json --quiet --out b" +
     sets("problem={name=\"gas\",start=\"file\",file=\"r/run.h5\",pair=\"lennard-jones\",container={kind=\"circle\",radius=1.5}}"))
case("gas/box_walls", "gas", "run s.toml --json --quiet --out r --set problem.container={kind=\"box\",size=[4,4]} --set run.steps=50")

# Resuming and replacing.
for scenario, steps in (("kepler", 600), ("henon", 5000), ("tube", 800), ("gas", 150), ("map", 900), ("driven", 800)):
    case(f"resume/{scenario}", scenario, "run s.toml --json --quiet --out r",
         f"run s.toml --json --quiet --out r --resume --set run.steps={steps}")
case("resume/section", "henon", "run s.toml --json --quiet --out r" + sets("run.section={coordinate=\"q1\"}", "run.lyapunov=2"),
     "run s.toml --json --quiet --out r --resume" + sets("run.section={coordinate=\"q1\"}", "run.lyapunov=2", "run.steps=4500"))
case("resume/mp", "henon", "run s.toml --json --quiet --out r" + sets("run.steps=50", "run.arithmetic=mp(40)"),
     "run s.toml --json --quiet --out r --resume" + sets("run.steps=120", "run.arithmetic=mp(40)"))
case("resume/other", "kepler", "run s.toml --quiet --out r", "run s.toml --json --quiet --out r --resume --set run.dt=0.2")
case("resume/nothing", "kepler", "run s.toml --json --quiet --out r --resume")
case("resume/there", "kepler", "run s.toml --quiet --out r", "run s.toml --json --quiet --out r")
case("resume/force", "kepler", "run s.toml --quiet --out r", "run s.toml --json --quiet --out r --force --set run.steps=20")
case("resume/foreign", "kepler", "run s.toml --json --quiet --out mine", more={"mine": "text\n"})

# Failures while running.
case("fails/not_converged", "double", "run s.toml --json --quiet --out r --set run.dt=3 --set method.max_iterations=3")
case("fails/halved", "double", "run s.toml --json --quiet --out r --set run.dt=0.5 --set method.on_divergence=halve --set run.steps=40")
case("fails/lattice", "runaway", "run s.toml --json --quiet --out r --set run.arithmetic=lattice")
case("fails/mp", "runaway", "run s.toml --json --quiet --out r --set run.arithmetic=mp(30) --set run.steps=60")
case("fails/warned", "kepler", "run s.toml --json --quiet --out none --set method={name=\"verlet\"} --set run.dt=2")

# Refusals.
for name, key in (("unknown_key", "run.stpes=3"), ("unknown_method", "method.name=velret"), ("number", "run.dt=zero"), ("range", "run.dt=0"),
                  ("both", "run.t_end=3"), ("closed_list", "run.arithmetic=duble"), ("wrong_type", "problem.orbit=3"),
                  ("method_option", "method.omega=3"), ("potential", "problem.potential=keppler"), ("short_state",
                  "problem.initial={q=[1],p=[0,1]}"), ("whole", "run.steps=1.5"), ("figures", "output.figures=[\"orbti\"]"),
                  ("section", "run.section={coordinate=\"z\"}"), ("event", "run.events=[{expression=\"x~+~zz\"}]"),
                  ("observable", "output.observables={a=\"x*\"}"), ("threads", "run.threads=2"), ("arithmetic", "run.arithmetic=mp(1)")):
    case(f"refused/{name}", "kepler", f"run s.toml --json --quiet --out none --set {key}")
case("refused/formula", "formula", "run s.toml --json --quiet --out none --set problem.hamiltonian=\"2p_x~+~zz\"")
case("refused/splitting", "coupled", "run s.toml --json --quiet --out none --set method.name=verlet")
case("refused/toml", "kepler", "run bad.toml --json --quiet --out none", more={"bad.toml": "[problem\nname = 3\n"})
case("refused/missing", "kepler", "run none.toml --json --quiet --out none")
case("refused/singular", "kepler", "run s.toml --json --quiet --out none --set problem.initial={q=[0,0],p=[0,1]}")
case("refused/wall", "fall", "run s.toml --json --quiet --out none --set problem.initial.q[0]=-3")
case("refused/constraint", "spherical", "run s.toml --json --quiet --out none --set problem.initial.q[0]=0.9")
case("refused/many", "kepler", "run bad.toml --json --quiet --out none",
     more={"bad.toml": '[problem]\nname = "pendulum"\nlenght = 1\n[method]\nname = "stv5"\n[run]\ndt = 0\nsteps = -3\n'})
case("refused/option", "kepler", "run s.toml --jsno")

# sweep.
case("sweep/states", "pendulum", "sweep s.toml --vary problem.initial.q[0]=-3:3:7 --vary problem.initial.p[0]=-1:1:3 --json --quiet --out w")
case("sweep/rows", "pendulum", "sweep s.toml --vary problem.initial.q[0]=-3:3:5 --json --quiet --out none --threads 1")
case("sweep/csv", "kepler", "sweep s.toml --vary problem.orbit.r_aph=1.5:4:6 --json --quiet --out w --set output.formats=[\"h5\",\"csv\"]")
case("sweep/methods", "henon", "sweep s.toml --vary method.name=verlet,stv4,cg(1,3) --vary run.dt=0.1,0.05 --json --quiet --out none --set run.steps=100")
case("sweep/zip", "henon", "sweep s.toml --vary run.dt=0.1,0.05 --vary run.steps=100,200 --zip --json --quiet --out none")
case("sweep/formula", "kepler", "sweep s.toml --vary problem.orbit.r_per=0.5:1:3 --vary problem.orbit.r_aph=3-problem.orbit.r_per --json --quiet --out none")
case("sweep/lanes", "henon", "sweep s.toml --vary problem.initial.q[1]=0.1:0.2:16 --json --quiet --out w --lanes generic --set run.steps=300")
case("sweep/lyapunov", "henon", "sweep s.toml --vary problem.initial.q[1]=0.1:0.2:4 --json --quiet --out w --set run.steps=500 --set run.lyapunov=1")
case("sweep/section", "henon", "sweep s.toml --vary problem.initial.q[1]=0.1:0.2:4 --json --quiet --out w --set run.section={coordinate=\"q1\"}")
case("sweep/observables", "henon", "sweep s.toml --vary problem.initial.q[1]=0.1:0.2:4 --json --quiet --out w --set run.steps=100" +
     sets("output.observables={a=\"q1^2\"}"))
case("sweep/walls", "fall", "sweep s.toml --vary problem.initial.q[0]=-0.5:1:4 --json --quiet --out w --set run.steps=300")
case("sweep/events", "kepler", "sweep s.toml --vary run.dt=0.1,0.05 --json --quiet --out w --set run.events=[{expression=\"x\"}]")
case("sweep/mp", "henon", "sweep s.toml --vary run.dt=0.1,0.05 --json --quiet --out w --set run.steps=50 --set run.arithmetic=mp(30)")
case("sweep/arithmetics", "oscillator", "sweep s.toml --vary run.arithmetic=double,lattice,compensated --json --quiet --out w --set run.steps=200")
case("sweep/failures", "runaway", "sweep s.toml --vary problem.initial.p[0]=-2:2:5 --json --quiet --out w")
case("sweep/no_start", "henon", "sweep s.toml --vary problem.initial.q[0]=0:2:5 --json --quiet --out w --set run.steps=100" +
     sets("problem.initial={q=[0,0.1],p=[\"+\",0.1],energy=0.125}"))
case("sweep/not_converged", "double", "sweep s.toml --vary run.dt=0.01,3 --json --quiet --out w --set run.steps=20 --set method.max_iterations=3")
case("sweep/all_fail", "runaway", "sweep s.toml --vary problem.initial.p[0]=3,4 --json --quiet --out w")
case("sweep/gas", "gas", "sweep s.toml --vary problem.seed=1,2,3 --json --quiet --out w --set run.steps=20")
case("sweep/problem", "tube", "sweep s.toml --vary problem.eps=-0.6,0.2 --json --quiet --out w --set run.steps=100")
case("sweep/resume", "pendulum", "sweep s.toml --vary problem.initial.q[0]=-3:3:5 --json --quiet --out w",
     "sweep s.toml --vary problem.initial.q[0]=-3:3:5 --json --quiet --out w --resume")
case("sweep/resume_other", "pendulum", "sweep s.toml --vary problem.initial.q[0]=-3:3:5 --quiet --out w",
     "sweep s.toml --vary problem.initial.q[0]=-3:3:6 --json --quiet --out w --resume")
case("sweep/there", "pendulum", "sweep s.toml --vary run.dt=0.1,0.05 --quiet --out w", "sweep s.toml --vary run.dt=0.1,0.05 --json --quiet --out w")
case("sweep/bad_value", "pendulum", "sweep s.toml --vary run.dt=0.1,0 --json --quiet --out none")
case("sweep/bad_key", "pendulum", "sweep s.toml --vary run.dtt=0.1,0.2 --json --quiet --out none")
case("sweep/bad_zip", "pendulum", "sweep s.toml --vary run.dt=0.1,0.05 --vary problem.initial.q[0]=1,2,3 --zip --json --quiet --out none")
case("sweep/reversible", "kepler", "sweep s.toml --vary run.dt=0.02,0.01 --json --quiet --out w" +
     sets("method={name=\"stv4\",step_control=\"reversible\"}"))

# compare.
case("compare/kepler", "kepler", "compare s.toml --methods verlet,stv4,cg(1,5) --dt 0.2,0.1 --json --quiet --out c")
case("compare/henon", "henon", "compare s.toml --methods stv4,rk4,dop853 --dt 0.2,0.1 --set run.t_end=10 --json --quiet --out none --csv c.csv")
case("compare/quad", "henon", "compare s.toml --methods stv4,gauss(3) --dt 0.2 --set run.t_end=4 --set run.arithmetic=double-double --json --quiet --out none")
case("compare/walls", "fall", "compare s.toml --methods verlet,cg --dt 0.02,0.01 --set run.t_end=1 --json --quiet --out none")
case("compare/blown", "runaway", "compare s.toml --methods verlet,rk4 --dt 0.5 --set run.t_end=1 --json --quiet --out none")
case("compare/refused", "coupled", "compare s.toml --methods verlet,tao2 --dt 0.02 --json --quiet --out none")
case("compare/unknown", "kepler", "compare s.toml --methods velret --json --quiet --out none")

# reverse.
case("reverse/lattice", "henon", "reverse s.toml --json --quiet --set run.arithmetic=lattice --out v")
case("reverse/double", "kepler", "reverse s.toml --json --quiet --out v")
case("reverse/rk4", "henon", "reverse s.toml --json --quiet --set method.name=rk4 --set run.steps=300")
case("reverse/mp", "oscillator", "reverse s.toml --json --quiet --set run.steps=50 --set run.arithmetic=mp(40) --out v")
case("reverse/gas", "gas", "reverse s.toml --json --quiet --set run.arithmetic=lattice --out v")
case("reverse/bodies", "eight", "reverse s.toml --json --quiet --set run.steps=200")
case("reverse/walls", "tube", "reverse s.toml --json --quiet --set run.steps=200")
case("reverse/fails", "runaway", "reverse s.toml --json --quiet --out v")
case("reverse/there", "henon", "reverse s.toml --quiet --set run.steps=50 --out v", "reverse s.toml --json --quiet --set run.steps=50 --out v",
     "reverse s.toml --json --quiet --set run.steps=50 --out v --resume")

# shell.
case("shell/steps", "kepler", "shell s.toml --json --quiet <<< step 10; show; dt 0.05; step 20; show; save a.run; reverse; step 5; show; quit")
case("shell/method", "henon", "shell s.toml --json --quiet <<< step 10; method gauss(2); tol 1e-10; step 5; show; reset; show; quit")
case("shell/wrong", "henon", "shell s.toml --json --quiet <<< stpe 10; step -1; dt 0; step 3; show; quit")
case("shell/mp", "henon", "shell s.toml --json --quiet --set run.arithmetic=mp(30) <<< step 4; show; save m.run; quit")

# convert.
case("convert/scenario", "kepler", "convert s.toml --to polar -o p.toml")
case("convert/state", "kepler", "convert --from cartesian --to polar --q 1,0.5 --p 0,1 --json")
case("convert/run", "kepler", "run s.toml --quiet --out r", "convert r --to polar -o p.csv", "convert r --to polar -o p.h5", "convert r --to polar --json")
case("convert/digits", "kepler", "run s.toml --quiet --out r --set run.steps=20 --set run.arithmetic=mp(30)", "convert r --to polar -o p.h5")
case("convert/pendulum", "spherical", "convert s.toml --to generalised -o g.toml")
case("convert/tube", "tube", "run s.toml --quiet --out r --set run.steps=50", "convert r --to cartesian -o c.h5")
case("convert/refused", "henon", "convert s.toml --to polar --json")

# plot: the files alone, figures have tests of their own.
case("plot/kinds", "kepler", "run s.toml --quiet --out r", *(f"plot r --kind {kind} -o {kind}.svg"
     for kind in ("orbit", "time", "energy", "energy-error", "phase")))
case("plot/refused", "kepler", "run s.toml --quiet --out r", "plot r --kind orbti -o a.svg", "plot r --kind section -o a.svg", "plot none -o a.svg",
     "plot r -o a.gif")

# list, show, new, verify.
case("list/all", "kepler", "list methods --json", "list problems --json", "list method --json")
for problem in ("central-force", "double-pendulum", "pendulum", "gas", "formula", "n-body", "t-tube"):
    case(f"new/{problem}", "kepler", f"new {problem}")
case("new/hooke", "kepler", "new central-force --potential hooke --coordinates polar", "new central-force --potential nothing", "new pendlum")
case("verify/few", "kepler", "verify verlet cg(1,5) --json")
case("verify/wrong", "kepler", "verify velret --json")
