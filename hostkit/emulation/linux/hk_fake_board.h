/* Time and the virtual sensor behind the faked devices. */
#ifndef HK_FAKE_BOARD_H
#define HK_FAKE_BOARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Take the table and the options that the environment names; called once, before main. */
void hk_fake_board_begin(void);

/* Whether the sensor keeps pace with the wall clock. */
bool hk_fake_realtime(void);

/* Time of the kernel's monotonic clock as the firmware sees it. */
uint64_t hk_fake_now_ns(void);

/* Let time pass, or catch up with the wall clock. */
void hk_fake_pass(uint64_t ns);
void hk_fake_catch_up(uint64_t wall_ns);

/* When something happens by itself next: the sensor, or bytes on the link. */
uint64_t hk_fake_next_ns(void);

/* Whether the table is at its end, or nobody has taken a row for long. */
bool hk_fake_ended(void);

/* One message of an I2C transfer, START included: 0 or the error of the kernel. */
int hk_fake_message(uint8_t address, bool read, uint8_t *bytes, size_t count);
void hk_fake_stop(void);

/* The INT pin: its level, and when it rose if that has not been told. */
bool hk_fake_pin(void);
bool hk_fake_edge(uint64_t *rose_ns);
bool hk_fake_edge_waits(void);

/* Bytes that have come over the link by now. */
size_t hk_fake_received(uint8_t *bytes, size_t room);
bool hk_fake_receives(void);

#endif
