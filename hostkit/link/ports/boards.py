"""What is probably behind the USB ids of a serial port."""

ARDUINO, ARDUINO_ORG = 0x2341, 0x2A03
RASPBERRY_PI = 0x2E8A
ST = 0x0483

BOARDS: dict[tuple[int, int], str] = {
    (ARDUINO, 0x0001): "Arduino Uno",
    (ARDUINO, 0x0043): "Arduino Uno",
    (ARDUINO, 0x0243): "Arduino Uno",
    (ARDUINO_ORG, 0x0043): "Arduino Uno",
    (ARDUINO, 0x0010): "Arduino Mega 2560",
    (ARDUINO, 0x0042): "Arduino Mega 2560",
    (ARDUINO_ORG, 0x0042): "Arduino Mega 2560",
    (ARDUINO, 0x8036): "Arduino Leonardo",
    (ARDUINO, 0x8037): "Arduino Micro",
    (ARDUINO, 0x0058): "Arduino Nano Every",
    (ARDUINO, 0x805A): "Arduino Nano 33 BLE",
    (ARDUINO, 0x0069): "Arduino Uno R4",
    (RASPBERRY_PI, 0x0005): "Raspberry Pi Pico with MicroPython",
    (RASPBERRY_PI, 0x0009): "Raspberry Pi Pico 2",
    (RASPBERRY_PI, 0x000A): "Raspberry Pi Pico",
    (RASPBERRY_PI, 0x000C): "Raspberry Pi Debug Probe",
    (ST, 0x374B): "ST-Link virtual port",
    (ST, 0x3752): "ST-Link virtual port",
    (ST, 0x374E): "ST-Link V3 virtual port",
    (ST, 0x374F): "ST-Link V3 virtual port",
    (ST, 0x3753): "ST-Link V3 virtual port",
    (ST, 0x5740): "STM32 with a USB port of its own",
    (0x1EAF, 0x0004): "Maple or Blue Pill with the Maple boot loader",
    (0x1A86, 0x7523): "CH340 adapter, as on many Arduino Nano",
    (0x1A86, 0x5523): "CH341 adapter",
    (0x1A86, 0x55D3): "CH343 adapter",
    (0x1A86, 0x55D4): "CH9102 adapter",
    (0x10C4, 0xEA60): "CP210x adapter",
    (0x0403, 0x6001): "FT232 adapter, as on older Arduino Nano",
    (0x0403, 0x6010): "FT2232 adapter",
    (0x0403, 0x6011): "FT4232 adapter",
    (0x0403, 0x6014): "FT232H adapter",
    (0x0403, 0x6015): "FT231X adapter",
    (0x067B, 0x2303): "PL2303 adapter",
    (0x303A, 0x1001): "ESP32 with a USB port of its own",
}
VENDORS = {ARDUINO: "Arduino", ARDUINO_ORG: "Arduino", RASPBERRY_PI: "Raspberry Pi"}


def board_of(vid: int, pid: int) -> str:
    """Return what a port with these ids probably is; empty if that is not known."""
    return BOARDS.get((vid, pid)) or VENDORS.get(vid, "")
