"""MuJoCo: drums as boxes that move in a plane, contact as stiff as the step allows, elliptic cones; the ground's motion as an inertial force.

The tolerance is the step [s]. What the scene answers are places [m] and angles [rad] of the drums at the end, base first.
"""

import math

import mujoco
import numpy as np

MODEL = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -{gravity}" cone="elliptic" impratio="100" solver="Newton" iterations="100" tolerance="1e-12"
    integrator="implicitfast"/>
  <default>
    <geom friction="{friction} 0 0" condim="3" solref="{time} 1" solimp="0.99 0.999 1e-5 0.5 2" margin="0"/>
  </default>
  <worldbody>
    <geom type="plane" size="50 50 1"/>
    {bodies}
  </worldbody>
</mujoco>
"""

BODY = """
    <body pos="0 0 {height}">
      <joint type="slide" axis="1 0 0"/> <joint type="slide" axis="0 0 1"/> <joint type="hinge" axis="0 1 0"/>
      <geom type="box" size="{width} {width} {half}" mass="{mass}"/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>
    </body>
"""


def drums(step, numbers):
    blocks, width, half, density, gravity, friction, amplitude, omega, t_end = numbers
    mass = 4.0 * width * half * density
    inertia = mass / 3.0 * (width * width + half * half)
    heights = np.array([(2 * i + 1) * half for i in range(int(blocks))])
    bodies = "".join(BODY.format(height=height, width=width, half=half, mass=mass, inertia=inertia) for height in heights)
    text = MODEL.format(step=step, gravity=gravity, friction=friction, time=2.0 * step, bodies=bodies)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)

    def run():
        mujoco.mj_resetData(model, data)
        for i in range(round(t_end / step)):
            phase = omega * i * step
            model.opt.gravity[0] = -amplitude * math.sin(phase) if phase <= math.tau else 0.0
            mujoco.mj_step(model, data)
        places = data.qpos.reshape(-1, 3).copy()
        places[:, 1] += heights
        return places.ravel().tolist()

    return run
