/* A virtual MPU-6050, register by register, for emulated boards and tests.
 *
 * Plain C99 without a C library: it is linked into a program, loaded as a shared object or compiled
 * to WebAssembly. It owns no clock and no memory; the caller passes the time, in nanoseconds that
 * never run backwards, and a table of physical samples, which it quantises with the range that the
 * registers select. */
#ifndef HK_VIRTUAL_MPU6050_H
#define HK_VIRTUAL_MPU6050_H

#include <stdbool.h>
#include <stdint.h>

#include "hk_mpu6050_regs.h"

/* One row of the table: angular rate x, y, z (rad/s), specific force x, y, z (m/s^2), temperature
 * (degC), in sensor axes. */
#define HK_ROW_VALUES 7

#define HK_VIRTUAL_REGISTERS 128
#define HK_NEVER UINT64_MAX

/* Which samples the sensor plays.
 *
 * Until data-ready is enabled (and, where the FIFO is on, until something is let into it) the sensor
 * shows the row that comes next. From the first sample after
 * the enabling on, that row comes settle times more, and then the rows follow, one per sample. At
 * the end of the table the sensor stops producing samples, or starts again with row 0. A driver
 * that drops exactly settle samples therefore sees every row once, however often it restarts. */
typedef struct {
    const double *rows;
    uint32_t row_count;
    uint32_t settle;
    bool loop;
    uint32_t next_row;
    uint32_t rows_played;
    uint32_t lead_in_left;
    bool running;
} hk_replay_t;

/* The way of the FIFO, as the register map tells it. */
typedef struct {
    uint8_t data[HK_MPU6050_FIFO_BYTES];
    uint16_t first; /* place of the oldest byte */
    uint16_t count;
    uint8_t last;   /* what an empty FIFO reads again */
} hk_virtual_fifo_t;

/* The digital low-pass of one axis: a section of second order, then a delay. */
#define HK_LOW_PASS_DELAY_TICKS 16
typedef struct {
    double state[2];
    double line[HK_LOW_PASS_DELAY_TICKS]; /* what has left the section, a ring */
} hk_virtual_low_pass_t;

/* Motion that is felt and filtered, instead of samples that are played. */
typedef struct {
    uint64_t row_period_ns; /* 0: rows are samples */
    uint64_t begin_ns;      /* when row 0 was; HK_NEVER until the motion begins */
    uint64_t tick_ns;       /* next step of the filters */
    uint32_t here;          /* place of the newest in the delay lines */
    bool settled;           /* the filters have seen row 0 for ever */
    double accel_hold[3];   /* at 1 kHz, whatever the gyroscope does */
    double gyro_hold[3];
    hk_virtual_low_pass_t axis[6]; /* angular rate x, y, z, specific force x, y, z */
} hk_virtual_motion_t;

/* The I2C side: who is addressed, and where the register pointer stands. */
typedef struct {
    bool open;
    bool pointer_expected;
    bool gone;          /* the sensor has let go of the bus until the next START */
    uint8_t bytes_read; /* in this transaction */
    uint8_t pointer;
} hk_slave_t;

/* What can be made to go wrong, each with an amount. */
typedef enum {
    HK_FAULT_NACK_ADDRESS,    /* so many addressings are not acknowledged */
    HK_FAULT_NACK_DATA,       /* so many written bytes are not acknowledged */
    HK_FAULT_TORN_BURST,      /* the next read that is longer than so many bytes breaks off there */
    HK_FAULT_STUCK_SDA,       /* SDA stays low until so many clocks have come */
    HK_FAULT_CLOCK_STRETCH,   /* SCL stays low for so many microseconds within the next byte */
    HK_FAULT_WRONG_IDENTITY,  /* WHO_AM_I reads so */
    HK_FAULT_REGISTER_UPSET,  /* register (amount / 256) is exclusive-ored with (amount % 256) */
    HK_FAULT_SELF_RESET,      /* the supply dips: reset; the amount is not used */
    HK_FAULT_FROZEN_DATA,     /* the data registers keep their values until a reset; not used */
    HK_FAULT_LOST_DATA_READY, /* so many samples are announced in INT_STATUS, but not on the pin */
    HK_FAULT_FIFO_OVERFLOW,   /* the sample enters the FIFO so many times more */
    HK_FAULT_TORN_COUNT,      /* the next reading of FIFO_COUNT_H is so */
    HK_FAULT_MISALIGNED,      /* so many bytes are lost from the FIFO */
    HK_FAULT_BROWN_OUT_WRITE, /* the supply dips in a register write, after so many good ones */
    HK_FAULT_STUCK_VALUE,     /* axis (amount % 256) stays for (amount / 256) samples */
    HK_FAULT_SATURATED_AXIS,  /* the same, but at the end of its range */
    HK_FAULT_WEAK_RESPONSE,   /* the self-test answers with so many percent of the trim */
    HK_FAULT_NO_TRIM,         /* the factory codes read 0; not used */
    HK_FAULT_KINDS
} hk_fault_kind_t;

/* Axes of faults: 0 to 2 accelerometer, 3 to 5 gyroscope. 0 samples: until a reset. */
#define HK_FAULT_AXES 6U

/* A fault that strikes when a row of the table is sampled. */
typedef struct {
    hk_fault_kind_t kind;
    uint32_t row;
    uint32_t amount;
    bool struck;
} hk_planned_fault_t;

#define HK_PLANNED_FAULTS 16

/* Faults on demand, and what went wrong on its own. */
typedef struct {
    hk_planned_fault_t planned[HK_PLANNED_FAULTS];
    uint32_t planned_count;
    uint32_t nack_left;       /* so many addressings are not acknowledged */
    uint32_t nack_data_left;  /* so many written bytes are not acknowledged */
    uint32_t sda_stuck_left;  /* SDA stays low until so many clocks have come */
    uint32_t stretch_us;      /* SCL will stay low for so long within the next byte */
    uint64_t scl_free_ns;     /* SCL is low until then */
    uint32_t lost_ready_left; /* so many samples will not be seen on the pin */
    uint32_t torn_after;      /* bytes of the read that breaks off */
    uint32_t extra_packets;   /* that the next sample puts into the FIFO */
    uint32_t lose_bytes;      /* of the FIFO, at the next sample */
    uint32_t good_writes;     /* before the supply dips */
    uint32_t stuck_left[HK_FAULT_AXES];     /* samples; HK_FOR_GOOD: until a reset */
    uint32_t saturated_left[HK_FAULT_AXES];
    uint8_t torn_count;
    bool count_is_torn;
    bool brown_out;
    bool torn;
    bool frozen;
    uint8_t who_am_i;        /* the identity the sensor answers with */
    uint8_t self_test[4];    /* factory codes: registers SELF_TEST_X to SELF_TEST_A */
    uint32_t unread_samples; /* samples that were replaced before anybody read them */
} hk_faults_t;

#define HK_FOR_GOOD UINT32_MAX

/* The self-test: what becomes of the factory's response. */
typedef struct {
    double share[6];      /* of the factory trim: accelerometer x, y, z, gyroscope x, y, z */
    uint64_t settling_ns; /* until the response is whole; it grows evenly */
    uint64_t gyro_ns;     /* when the bits were written last */
    uint64_t accel_ns;
} hk_virtual_response_t;

typedef struct {
    uint8_t reg[HK_VIRTUAL_REGISTERS];
    uint8_t pending[HK_MPU6050_BURST_BYTES]; /* waits for the end of a transaction */
    bool pending_full;
    bool pending_ready; /* it was sampled with data-ready enabled */
    bool latch; /* the INT pin, before its polarity */
    bool first_address_bit;  /* the AD0 pin */
    uint8_t count_low;       /* FIFO_COUNT_L as it was when FIFO_COUNT_H was read */
    uint64_t now_ns;
    uint64_t sample_ns;      /* next output sample */
    uint64_t announced_ns;   /* when INT rose last */
    uint64_t path_free_ns[3]; /* temperature, accelerometer, gyroscope: reset until then */
    uint64_t reset_start_ns; /* of a device reset under way */
    uint64_t reset_end_ns;
    uint64_t pll_locked_ns;
    uint64_t pulse_end_ns;
    hk_slave_t slave;
    hk_replay_t replay;
    hk_virtual_fifo_t fifo;
    hk_virtual_motion_t motion;
    hk_virtual_response_t response;
    hk_faults_t faults;
} hk_virtual_mpu6050_t;

/* Size of the struct, for callers that are not C. */
uint32_t hk_virtual_mpu6050_size(void);

/* Power up at time 0, asleep, with a table of row_count rows of HK_ROW_VALUES. */
void hk_virtual_mpu6050_init(hk_virtual_mpu6050_t *sensor, const double *rows, uint32_t row_count,
                             uint32_t settle, bool loop);

/* Faults on demand; 0 and the true identity are what init sets. */
void hk_virtual_mpu6050_set_identity(hk_virtual_mpu6050_t *sensor, uint8_t who_am_i);
void hk_virtual_mpu6050_nack_next(hk_virtual_mpu6050_t *sensor, uint32_t addressings);
void hk_virtual_mpu6050_hold_sda(hk_virtual_mpu6050_t *sensor, uint32_t clocks);

/* Plan a fault for the sampling of a row, or for now: what concerns only the bus or the identity
 * strikes at once if the row is 0. False if there are too many, or if there is no such kind. */
bool hk_virtual_mpu6050_plan(hk_virtual_mpu6050_t *sensor, uint32_t kind, uint32_t row,
                             uint32_t amount);

/* Faults that have struck so far. */
uint32_t hk_virtual_mpu6050_struck(const hk_virtual_mpu6050_t *sensor);

/* Factory codes of the self-test, as the registers SELF_TEST_X to SELF_TEST_A hold them; init sets
 * some that a part may have, 0 means none. */
void hk_virtual_mpu6050_set_self_test(hk_virtual_mpu6050_t *sensor, uint8_t x, uint8_t y, uint8_t z,
                                      uint8_t a);

/* Which share of the factory trim the self-test of an axis answers with (accelerometer x, y, z,
 * gyroscope x, y, z; 1 after init), and how long it takes to come. */
void hk_virtual_mpu6050_set_response(hk_virtual_mpu6050_t *sensor, uint32_t axis, double share);
void hk_virtual_mpu6050_set_settling(hk_virtual_mpu6050_t *sensor, uint64_t settling_ns);

/* Level of the AD0 pin: the address is 0x68, or 0x69 if it is high. */
void hk_virtual_mpu6050_set_ad0(hk_virtual_mpu6050_t *sensor, bool high);

/* Take the rows for motion, one every row_period_ns, instead of for samples: the sensor feels it,
 * with a straight line from row to row, and filters it as DLPF_CFG says. Row 0 is felt until the
 * first sample that is not one of the settle samples, then the motion runs with the clock, whatever
 * becomes of the sensor. */
void hk_virtual_mpu6050_feel_motion(hk_virtual_mpu6050_t *sensor, uint64_t row_period_ns);

/* How long SCL stays low from now on; the master asks before each byte. */
uint64_t hk_virtual_mpu6050_stretch_ns(hk_virtual_mpu6050_t *sensor);

/* Let time pass. Every other call acts at the time of the last advance. */
void hk_virtual_mpu6050_advance(hk_virtual_mpu6050_t *sensor, uint64_t now_ns);

/* The I2C bus. start also is the repeated start; it returns the acknowledge. */
bool hk_virtual_mpu6050_start(hk_virtual_mpu6050_t *sensor, uint8_t address, bool read);
bool hk_virtual_mpu6050_write(hk_virtual_mpu6050_t *sensor, uint8_t byte);
uint8_t hk_virtual_mpu6050_read(hk_virtual_mpu6050_t *sensor);
void hk_virtual_mpu6050_stop(hk_virtual_mpu6050_t *sensor);

/* One clock without a transaction, as a master gives it that frees the bus; and the state of SDA. */
void hk_virtual_mpu6050_clock(hk_virtual_mpu6050_t *sensor);
bool hk_virtual_mpu6050_sda_low(const hk_virtual_mpu6050_t *sensor);

/* Level of the INT pin, with a pull-up where it is open drain; and whether the sensor drives it. */
bool hk_virtual_mpu6050_int_pin(const hk_virtual_mpu6050_t *sensor);
bool hk_virtual_mpu6050_int_driven(const hk_virtual_mpu6050_t *sensor);

/* Next time at which something changes by itself, or HK_NEVER. */
uint64_t hk_virtual_mpu6050_next_event_ns(const hk_virtual_mpu6050_t *sensor);

/* When INT rose last: the time of the sample that it announces. */
uint64_t hk_virtual_mpu6050_published_ns(const hk_virtual_mpu6050_t *sensor);

/* True when the last row has been published and read, which a looping table never is. */
bool hk_virtual_mpu6050_exhausted(const hk_virtual_mpu6050_t *sensor);

/* Rows published so far, and samples that nobody read before the next came, or that were pushed out
 * of the FIFO. */
uint32_t hk_virtual_mpu6050_rows_played(const hk_virtual_mpu6050_t *sensor);
uint32_t hk_virtual_mpu6050_unread_samples(const hk_virtual_mpu6050_t *sensor);

#endif
