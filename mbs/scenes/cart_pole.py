"""Cart-pole with a light cart: a heavy bob on a massless pole that hangs on a cart of a millionth of its mass. The bob
falls almost straight down and the cart swings round beneath it at thousands of rad/s.
"""

from mbs.model.model import Model

CART, BOB = 1e-6, 1.0  # kg
LENGTH = 1.0  # m
GRAVITY = 9.81  # m/s2


def build(cart_mass: float = CART) -> Model:
    """Pole horizontal, at rest.

    Parameters
    ----------
    cart_mass : float
        kg.
    """
    m = Model("cart-pole", dimension=2, gravity=(0.0, -GRAVITY))
    cart = m.point_mass("cart", mass=cart_mass, position=(0.0, 0.0))
    bob = m.point_mass("bob", mass=BOB, position=(LENGTH, 0.0))
    m.point_on_line("rail", (cart, (0.0, 0.0)), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    m.distance("pole", cart, bob)
    m.sense_position("cart.position.x", cart, None, "x", description="position of the cart")
    for component in "xy":
        m.sense_position(
            f"bob.position.{component}", bob, None, component, description=f"position of the bob along {component}"
        )
    m.sense_energy("energy.total", "total", description="kinetic and potential energy")
    return m
