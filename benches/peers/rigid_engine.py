"""The wall in MuJoCo: two boxes that touch a plane and each other, a spring at the top, the ground's motion as gravity.

MuJoCo resolves contacts by soft constraints, so they give a little, and coefficients of impact cannot be set: it is
compared with plastic impacts alone, C_l = 1. Bodies cannot slide here either: friction is made large.
"""

import math

import mujoco
import numpy as np

GRAVITY = 9.81
DEPTH = 0.5  # of the bodies, out of the picture's plane: it plays no part

MODEL = """
<mujoco>
  <option timestep="{step}" gravity="0 0 -{g}" integrator="implicitfast" cone="elliptic" impratio="10"
          iterations="50" tolerance="1e-10"/>
  <default><geom friction="2 0 0" condim="3" solref="{time_constant} 1" solimp="0.99 0.9999 0.0001"/></default>
  <worldbody>
    <geom name="ground" type="plane" size="5 5 1" contype="1" conaffinity="0"/>
    <body name="lower" pos="0 0 {z1}">
      <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><joint name="theta1" type="hinge" axis="0 1 0"/>
      <inertial pos="0 0 0" mass="{m1}" diaginertia="{i1} {i1} {i1}"/>
      <geom type="box" size="{b1} {depth} {z1}" contype="0" conaffinity="1"/>
      <geom type="box" size="{b} {depth} {z1}" contype="2" conaffinity="0"/>
    </body>
    <body name="carriage" pos="0 0 {h}">
      <joint type="slide" axis="1 0 0" stiffness="{k}"/>
      <inertial pos="0 0 0" mass="{mdp}" diaginertia="1 1 1"/>
      <body name="upper">
        <joint type="slide" axis="0 0 1"/><joint name="theta2" type="hinge" axis="0 1 0"/>
        <inertial pos="0 0 {z_g}" mass="{m}" diaginertia="{i} {i} {i}"/>
        <geom type="box" pos="0 0 -{z2}" size="{b2} {depth} {z2}" contype="0" conaffinity="2"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def model(wall, step_s):
    """MuJoCo's model of a `two_bodies.TwoBodies`: the carriage slides along x, and the upper body hangs on it at C."""
    m = wall.m2 + wall.md
    # Centre of mass of the upper body with m_d at C, above C, and its moment of inertia.
    z_g = -wall.m2 * wall.h2 / 2 / m
    i = wall.i2 + wall.m2 * (wall.h2 / 2 + z_g) ** 2 + wall.md * z_g**2
    text = MODEL.format(
        step=step_s, g=GRAVITY, time_constant=2 * step_s, depth=DEPTH, z1=wall.h1 / 2, z2=wall.h2 / 2, h=wall.h1 + wall.h2,
        m1=wall.m1, i1=wall.i1, b1=wall.b1 / 2, b=wall.b / 2, b2=wall.b2 / 2, k=wall.k, mdp=wall.mdp, z_g=z_g, m=m, i=i)
    return mujoco.MjModel.from_xml_string(text)


def simulate(wall, times, accelerations, end_s, step_s):
    """Largest rotations of a run from rest."""
    engine = model(wall, step_s)
    data = mujoco.MjData(engine)
    at = [engine.jnt_qposadr[mujoco.mj_name2id(engine, mujoco.mjtObj.mjOBJ_JOINT, name)] for name in ("theta1", "theta2")]
    steps = math.ceil(end_s / step_s)
    ground = np.interp(np.arange(steps) * step_s, times, accelerations, right=0.0)
    largest = [0.0, 0.0]
    for k in range(steps):
        engine.opt.gravity[0] = -ground[k]
        mujoco.mj_step(engine, data)
        for i in (0, 1):
            largest[i] = max(largest[i], abs(data.qpos[at[i]]))
    return {"largest": largest}
