"""Robots' files written for the tests."""

from __future__ import annotations

HOPPER = """
<mujoco model="small_hopper">
  <compiler angle="radian" inertiafromgeom="true"/>
  <default>
    <joint armature="0.5" damping="1" limited="true"/>
    <geom contype="1" conaffinity="1" friction="0.9"/>
  </default>
  <worldbody>
    <geom name="floor" type="plane" size="9 9 .1" friction="1.2" conaffinity="1"/>
    <body name="torso" pos="0 0 1.25">
      <joint name="rootx" type="slide" axis="1 0 0" armature="0" damping="0" limited="false"/>
      <joint name="rootz" type="slide" axis="0 0 1" armature="0" damping="0" limited="false" ref="1.25"/>
      <joint name="rooty" type="hinge" axis="0 1 0" armature="0" damping="0" limited="false"/>
      <geom name="torso_geom" type="capsule" size="0.05 0.2"/>
      <body name="leg" pos="0 0 -0.7">
        <joint name="knee" type="hinge" axis="0 -1 0" pos="0 0 0.5" range="-2.6 0" stiffness="3"/>
        <geom name="leg_geom" type="capsule" size="0.04 0.25"/>
        <body name="foot" pos="0.13 0 -0.35">
          <joint name="ankle" type="hinge" axis="0 -1 0" pos="-0.13 0 0.1" range="-0.78 0.78"/>
          <geom name="foot_geom" type="capsule" size="0.06 0.195" pos="-0.065 0 0.1"
                quat="0.7071067811865476 0 -0.7071067811865475 0" friction="2"/>
        </body>
      </body>
    </body>
    <body name="stone" pos="3 0 0.1"><joint type="slide" name="stone_x" axis="1 0 0" limited="false"/>
      <geom name="stone_geom" type="sphere" size="0.1"/></body>
  </worldbody>
  <actuator><motor joint="knee" gear="100"/></actuator>
</mujoco>
"""

ARM = """
<mujoco model="small_arm">
  <compiler angle="radian"/>
  <option gravity="0 0 -9.81"/>
  <worldbody>
    <body name="shoulder" pos="0.1 -0.2 0.3" quat="0.9 0.1 -0.3 0.2">
      <inertial pos="0.02 0.01 -0.1" mass="2" fullinertia="0.03 0.04 0.02 0.002 -0.001 0.003"/>
      <joint name="pan" type="hinge" axis="0 0 1" damping="0.3"/>
      <joint name="lift" type="hinge" axis="0 1 1" pos="0 0.05 0" armature="0.1"/>
      <body name="forearm" pos="0.4 0 0.1" quat="1 0.2 0 0.4">
        <inertial pos="0.2 0 0" mass="1" diaginertia="0.01 0.02 0.02" quat="0.8 0 0.6 0"/>
        <joint name="reach" type="slide" axis="1 0 0.2" ref="0.1" range="-0.5 0.5" limited="true"/>
        <joint name="roll" type="hinge" axis="1 0 0"/>
        <geom name="tip" type="sphere" size="0.03" pos="0.4 0.1 0" mass="0"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""

URDF = """
<robot name="pendulum">
  <link name="base"/>
  <link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="1.5"/>
    <inertia ixx="0.1" iyy="0.09" izz="0.02" ixy="0" ixz="0.002" iyz="0"/></inertial></link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="rod"/><origin xyz="0 0 1" rpy="0 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/><dynamics damping="0.1"/></joint>
</robot>
"""
