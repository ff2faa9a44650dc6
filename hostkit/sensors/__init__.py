"""Sensors: one module per part, the single source of its registers, scale factors and noise."""

from hostkit.registry import Registry
from hostkit.sensors.mpu6050 import MPU6050
from hostkit.sensors.part import SensorPart

SENSORS: Registry[SensorPart] = Registry("sensor", (MPU6050,))
