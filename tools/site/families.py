"""One step of each family of methods, as formulas, and the scenario on which its work and precision are measured."""

SPLITTING = """for i = 1 .. s:
  q <- q + a_i h dT/dp(p)        drift
  p <- p - b_i h dV/dq(q)        kick"""

FORMULA = {
    "composition": "S_h = Verlet_(g_1 h) . Verlet_(g_2 h) ... Verlet_(g_s h)\n\n"
                   "Verlet_h:  p <- p - h/2 dV/dq(q),  q <- q + h dT/dp(p),  p <- p - h/2 dV/dq(q)\n"
                   "-dkd:      q <- q + h/2 dT/dp(p),  p <- p - h dV/dq(q),  q <- q + h/2 dT/dp(p)",
    "splitting": SPLITTING,
    "force-gradient": SPLITTING + "\nwith the force of V + c h^2 |M^(-1/2) dV/dq|^2 in some of the kicks",
    "runge-kutta": "k_i = J dH(z_0 + h sum_(j<i) a_ij k_j),   z_1 = z_0 + h sum_i b_i k_i",
    "cg": "z(t) a polynomial of degree k,   integral of P_i (z' - J dH(z)) dt = 0   for i = 0 .. k - 1\n"
          "the integrals by Gauss quadrature with s points",
    "avf": "z_1 = z_0 + h integral_0^1 J dH(z_0 + c (z_1 - z_0)) dc",
    "gauss": "Z_i = z_0 + h sum_j a_ij J dH(Z_j),   z_1 = z_0 + h sum_i b_i J dH(Z_i),   c_i the zeros of the Legendre polynomial P_s",
    "implicit-midpoint": "z_1 = z_0 + h J dH((z_0 + z_1)/2)",
    "lobatto-3a-3b": "Q_i = q_0 + h sum_j a_ij dH/dp(Q_j, P_j),   P_i = p_0 - h sum_j A_ij dH/dq(Q_j, P_j)\n"
                     "b_i A_ij + b_j a_ji = b_i b_j,   a_ij of Lobatto IIIA",
    "discrete-gradient": "z_1 = z_0 + h J DH(z_0, z_1)\n"
                         "DH = dH(m) + (H(z_1) - H(z_0) - dH(m).(z_1 - z_0))/|z_1 - z_0|^2 (z_1 - z_0),   m = (z_0 + z_1)/2",
    "itoh-abe": "z_1 = z_0 + h J DH(z_0, z_1),   (DH)_i a difference quotient of H in the i-th coordinate alone",
    "eg": "elements of degree k whose pair forces are multiplied by a factor for each pair, so that H, sum p and sum q x p stay constant",
    "rattle": "p_(1/2) = p_0 - h/2 (dV/dq(q_0) + g'(q_0)^T lambda),   q_1 = q_0 + h M^-1 p_(1/2),   g(q_1) = 0\n"
              "p_1 = p_(1/2) - h/2 (dV/dq(q_1) + g'(q_1)^T mu),   g'(q_1) M^-1 p_1 = 0",
    "boris": "v <- v + h/2 F/m,   v <- rotated by the magnetic field over h,   v <- v + h/2 F/m,   x <- x + h v",
    "tao": "K(q, p, x, y) = H(q, y) + H(x, p) + omega (|q - x|^2 + |p - y|^2)/2,   each of the three parts solved exactly",
    "wisdom-holman": "H = A + B:   A the Kepler motion of each planet, B the attractions between planets\n"
                     "S_h = A_(h/2) . B_h . A_(h/2),   with a corrector C^-1 . S_h . C",
    "saba": "H = A + B as for wisdom-holman\nS_h = A_(a_1 h) . B_(b_1 h) . A_(a_2 h) ... B_(b_s h) . A_(a_(s+1) h)",
    "dop853": "explicit Runge-Kutta of order 8 with 12 stages, errors by embedded formulas of order 5 and 3",
    "taylor": "z(t + h) = sum_k z_k h^k,   z_k by automatic differentiation of J dH",
}

HENON = """[problem]
name = "henon-heiles"
initial = { q = [0, 0.1], p = [0.45, 0] }
[method]
name = "verlet"
[run]
dt = 0.1
steps = 500
"""
KEPLER = """[problem]
name = "central-force"
potential = "kepler"
orbit = { kind = "ellipse", r_per = 1.0, r_aph = 3.0 }
[method]
name = "verlet"
[run]
dt = 0.1
steps = 1000
"""
MAGNETIC = """[problem]
name = "magnetic"
initial = { q = [1, 0, 0], p = [0, 0.5, 0.1] }
[method]
name = "boris"
[run]
dt = 0.1
steps = 500
"""
PENDULUM = """[problem]
name = "pendulum"
coordinates = "cartesian"
dimension = 2
constraint_form = "manifold"
initial = { q = ["sin(1)", "-cos(1)"], p = [0, 0] }
[method]
name = "rattle"
[run]
dt = 0.1
steps = 200
"""
PLANETS = """[problem]
name = "solar-system"
[method]
name = "wisdom-holman"
[run]
dt = 50
steps = 1000
"""
# What a family is measured on, what is drawn beside it, and the words for it.
MEASURED_ON = {"eg": (KEPLER, ["verlet", "stv4"], "an ellipse of Kepler's problem"),
               "rattle": (PENDULUM, ["rattle", "rattle4"], "a pendulum in Cartesian coordinates"),
               "wisdom-holman": (PLANETS, ["verlet", "stv4", "wisdom-holman"], "the outer Solar System"),
               "saba": (PLANETS, ["verlet", "stv4", "wisdom-holman"], "the outer Solar System"),
               "boris": (MAGNETIC, ["gauss", "cg"], "a charge in a uniform magnetic field")}
USUAL = (HENON, ["verlet", "stv4", "kahan-li8"], "an orbit of Henon and Heiles")
