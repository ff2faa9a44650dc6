/* Puts lines of text together, for STATUSTEXT. */
#ifndef HK_TEXT_H
#define HK_TEXT_H

#include <stdint.h>

#include "hk_flash.h"
#include "hk_mavlink.h"

typedef struct {
    mavlink_statustext_t message;
    uint8_t length; /* what does not fit any more is left out */
} hk_line_t;

void hk_line_init(hk_line_t *line, uint8_t severity);

/* Append a text that stands in flash: HK_TEXT("..."). */
void hk_line_put(hk_line_t *line, const char *flash_text);

/* Append a byte as 0x and two digits, or a number in decimal. */
void hk_line_put_hex(hk_line_t *line, uint8_t value);
void hk_line_put_number(hk_line_t *line, uint16_t value);

#endif
