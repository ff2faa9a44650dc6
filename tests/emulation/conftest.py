from boards import avr_folder, host_folder, pico_folder, stm32_folder

__all__ = ["avr_folder", "host_folder", "pico_folder", "stm32_folder"]
