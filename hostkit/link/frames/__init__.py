"""MAVLink frames: taken out of bytes, counted, signed, timed, made."""
