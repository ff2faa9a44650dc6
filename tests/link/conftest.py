from boards import host_folder

__all__ = ["host_folder"]
