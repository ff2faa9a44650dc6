"""The bounded-velocity observer of orientation."""
