/* The checksum of MAVLink frames and of the stored record: CRC-16/MCRF4XX. */
#ifndef HK_CRC_H
#define HK_CRC_H

#include <stdint.h>

#define HK_CRC_START 0xFFFFU

/* The checksum after one more byte. */
uint16_t hk_crc(uint16_t crc, uint8_t byte);

#endif
