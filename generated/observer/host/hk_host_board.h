/* The host "board": virtual time, the virtual sensor on its bus, the link on standard output. */
#ifndef HK_HOST_BOARD_H
#define HK_HOST_BOARD_H

#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>

#include "hk_hal.h"
#include "hk_virtual_mpu6050.h"

/* A planned fault: see hk_virtual_mpu6050_plan. */
typedef struct {
    uint32_t kind;
    uint32_t row;
    uint32_t amount;
} hk_host_fault_t;

typedef struct {
    const double *rows;
    uint32_t row_count;
    uint32_t settle;
    bool realtime; /* keep pace with the wall clock and loop the table */
    int who_am_i;  /* identity to answer with, or -1 for the true one */
    uint32_t nack;
    uint32_t hold_sda;
    uint32_t fault_row; /* nack and hold_sda begin when so many rows have been played */
    hk_host_fault_t faults[HK_PLANNED_FAULTS];
    uint32_t fault_count;
    const char *store;    /* file of the non-volatile store, or NULL */
    const char *received; /* file of what the link receives, or NULL */
    long power_cut;       /* bytes written to the store before the supply fails, or -1 */
} hk_host_options_t;

typedef struct {
    uint32_t rows_played;
    uint32_t unread_samples;
    uint32_t struck; /* planned faults that have come */
    uint32_t resets; /* of the processor */
    bool stalled; /* no row was taken for a long time, so the run was ended */
    double time_s;
} hk_host_statistics_t;

/* Returns false if a file cannot be used. */
bool hk_host_board_init(const hk_host_options_t *options);

/* Where a processor that is reset goes on; to be set before anything else of the hk_hal is used. */
extern jmp_buf hk_host_reset_vector;

/* Reset the processor, and after HK_RESET_POWER the sensor too. Does not return. */
void hk_host_board_restart(hk_reset_cause_t cause);

/* Time since the program began. */
uint64_t hk_host_board_now_ns(void);

/* True when the table has been played, nobody reads any more, or hk_host_board_stop was called. */
bool hk_host_board_finished(void);

/* End the run; may be called from a signal handler. */
void hk_host_board_stop(void);

hk_host_statistics_t hk_host_board_statistics(void);

#endif
