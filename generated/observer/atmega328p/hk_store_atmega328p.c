/* The non-volatile store of the ATmega328P: the first 256 bytes of its EEPROM, slot after slot.
 *
 * A byte takes 3.4 ms, erasing included, and may be replaced 100000 times; one that does not change
 * is not written. */
#include <avr/eeprom.h>

#include "hk_hal.h"

static uint16_t next; /* byte to be put, counted from the start of the EEPROM */
static uint16_t end;  /* of the slot that is replaced */

/* The EEPROM has addresses of its own. */
static uint8_t *place(uint16_t address)
{
    return (uint8_t *)address;
}

/* Waits for the byte that is being written, if there is one. */
void hk_hal_store_read(uint8_t slot, uint8_t offset, uint8_t *bytes, uint8_t count)
{
    eeprom_read_block(bytes, place((uint16_t)(slot * HK_STORE_SLOT_BYTES + offset)), count);
}

bool hk_hal_store_busy(void)
{
    return !eeprom_is_ready();
}

/* Bytes are erased one by one, as they are replaced. */
void hk_hal_store_erase(uint8_t slot)
{
    next = (uint16_t)(slot * HK_STORE_SLOT_BYTES);
    end = (uint16_t)(next + HK_STORE_SLOT_BYTES);
}

void hk_hal_store_put(uint8_t byte)
{
    if (next < end) {
        eeprom_update_byte(place(next), byte);
        next++;
    }
}

void hk_hal_store_finish(void)
{
    end = 0U;
}
