/* A board for fuzzing: the hardware layer over one input, see hk_hal.h. */
#ifndef FUZZ_BOARD_H
#define FUZZ_BOARD_H

#include <stddef.h>
#include <stdint.h>

/* The bytes that decide what happens; when they are used up, everything is well. */
typedef struct {
    const uint8_t *data;
    size_t left;
} fuzz_input_t;

uint8_t fuzz_take(fuzz_input_t *input);

/* Start a board whose sensor answers faithfully, or as `trouble` says if it is not NULL. */
void fuzz_board_start(fuzz_input_t *trouble);

/* Let time pass. */
void fuzz_board_pass(uint32_t us);

/* Bytes for the link. */
void fuzz_board_receive(const uint8_t *bytes, size_t count);
size_t fuzz_board_unread(void);

/* What the firmware did. */
uint32_t fuzz_board_samples(void);  /* TILT_SAMPLE frames */
uint32_t fuzz_board_erasures(void); /* of the non-volatile store */
int fuzz_board_rebooted(void);

#endif
