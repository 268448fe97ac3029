"""When a film is no longer laminar, and what its inertia does to it: numbers to hold a run's assumptions against."""


def couette_reynolds(density, viscosity, sliding_speed, thickness):
    """Couette Reynolds number rho U h / mu of a film of this `thickness` (m) between faces that slide at
    `sliding_speed` (m/s).
    **Valid** the flow stays laminar below some 1000 and is turbulent beyond some 2000.
    **Source** Constantinescu (1959), Trans. ASME J. Basic Eng. 81, 449.
    """
    return density * abs(sliding_speed) * thickness / viscosity


def poiseuille_reynolds(density, viscosity, flow_per_width):
    """Poiseuille Reynolds number rho q / mu of a `flow_per_width` (m^2/s, mean velocity times film thickness).
    **Valid** the flow stays laminar below some 1000.
    """
    return density * abs(flow_per_width) / viscosity


def centrifugal_pressure(density, stator_speed, rotor_speed, inner_radius, outer_radius):
    """Pressure (Pa) that the spin of a film's fluid builds up from the inner to the outer radius, without flow:
    `rho (3 W_s^2 + 4 W_s W_r + 3 W_r^2)/20 (r_o^2 - r_i^2)`, speeds of both faces in rad/s.
    **Source** the radial momentum of Couette flow, weighed with the profile of the flow it drives.
    """
    spins = 3.0 * stator_speed**2 + 4.0 * stator_speed * rotor_speed + 3.0 * rotor_speed**2
    return density * spins / 20.0 * (outer_radius**2 - inner_radius**2)
