"""The supply of the board: what its return does to the sensor."""

from hostkit.emulation.virtual_sensor import VirtualSensor

SENSOR, PWR_MGMT_1, DEVICE_RESET = 0x68, 0x6B, 0x80


def power_again(sensor: VirtualSensor, now_ns: int) -> None:
    """Take the sensor's supply away and give it back: it is as after a reset on demand."""
    sensor.advance(now_ns)
    sensor.stop()
    sensor.nack_next(0)
    sensor.hold_sda(0)
    sensor.start(SENSOR, read=False)
    sensor.write(PWR_MGMT_1)
    sensor.write(DEVICE_RESET)
    sensor.stop()
