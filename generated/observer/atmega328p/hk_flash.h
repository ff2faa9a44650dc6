/* Constants that stay in flash, also where a processor has separate addresses for it. */
#ifndef HK_FLASH_H
#define HK_FLASH_H

#include <stdint.h>

#ifdef __AVR__
#include <avr/pgmspace.h>
#define HK_FLASH PROGMEM
#define hk_flash_u8(address)  pgm_read_byte(address)
#define hk_flash_u16(address) pgm_read_word(address)
#define hk_flash_u32(address) pgm_read_dword(address)
/* A text where it stands in an expression; read it with hk_flash_u8. */
#define HK_TEXT(text) PSTR(text)
#else
#define HK_FLASH
#define hk_flash_u8(address)  (*(const uint8_t *)(address))
#define hk_flash_u16(address) (*(const uint16_t *)(address))
#define hk_flash_u32(address) (*(const uint32_t *)(address))
#define HK_TEXT(text) (text)
#endif

#endif
