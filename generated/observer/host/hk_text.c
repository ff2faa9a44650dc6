/* Lines of text: see the header. */
#include "hk_text.h"

#include <string.h>

static void put_character(hk_line_t *line, uint8_t character)
{
    if (line->length < sizeof line->message.text) {
        line->message.text[line->length++] = (char)character;
    }
}

static void put_digit(hk_line_t *line, uint8_t digit)
{
    put_character(line, (uint8_t)(digit < 10U ? '0' + digit : 'A' - 10 + digit));
}

void hk_line_init(hk_line_t *line, uint8_t severity)
{
    (void)memset(line, 0, sizeof *line);
    line->message.severity = severity;
}

void hk_line_put(hk_line_t *line, const char *flash_text)
{
    uint8_t character;

    for (; (character = hk_flash_u8(flash_text)) != 0U; flash_text++) {
        put_character(line, character);
    }
}

void hk_line_put_hex(hk_line_t *line, uint8_t value)
{
    hk_line_put(line, HK_TEXT("0x"));
    put_digit(line, value >> 4);
    put_digit(line, value & 0x0FU);
}

void hk_line_put_number(hk_line_t *line, uint16_t value)
{
    uint16_t unit = 10000U;

    while (unit > 1U && value < unit) {
        unit /= 10U;
    }
    for (; unit > 0U; unit /= 10U) {
        put_digit(line, (uint8_t)(value / unit % 10U));
    }
}
