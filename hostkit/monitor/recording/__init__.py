"""What a session writes: logs of frames, and recordings of samples."""
