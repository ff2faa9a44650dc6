"""The link: transports, MAVLink decoding, link statistics."""
