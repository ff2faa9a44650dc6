/* Checksum: see the header. */
#include "hk_crc.h"

/* Polynomial x^16 + x^12 + x^5 + 1, bits reflected: eight steps of the division at once. */
uint16_t hk_crc(uint16_t crc, uint8_t byte)
{
    const uint8_t low = (uint8_t)(byte ^ (uint8_t)crc);
    const uint8_t mixed = (uint8_t)(low ^ (uint8_t)(low << 4));

    return (uint16_t)((uint16_t)(crc >> 8) ^ (uint16_t)((uint16_t)mixed << 8)
                      ^ (uint16_t)((uint16_t)mixed << 3) ^ (uint16_t)(mixed >> 4));
}
