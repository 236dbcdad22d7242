"""The vehicles: the Crazyflie, the performer and the observers."""
