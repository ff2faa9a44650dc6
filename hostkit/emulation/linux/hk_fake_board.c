/* Time and the virtual sensor behind the faked devices: see the header. */
#include "hk_fake_board.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hk_virtual_mpu6050.h"

#define HK_NS_PER_S   UINT64_C(1000000000)
#define HK_BOOT_NS    HK_NS_PER_S       /* the clock does not begin at 0 */
#define HK_BIT_NS     UINT64_C(2500)    /* 400 kHz */
#define HK_TIMEOUT_NS UINT64_C(10000000)
#define HK_STALL_NS   (5U * HK_NS_PER_S)
#define HK_RECOVERY_CLOCKS 9

static struct {
    hk_virtual_mpu6050_t sensor;
    double *rows;
    uint32_t row_count;
    const char *statistics;
    bool realtime;
    uint32_t nack;
    uint32_t hold_sda;
    uint32_t fault_row;
    bool armed;
    uint64_t wall_start_ns; /* realtime: what the wall clock said first */
    uint64_t now_ns;        /* since the start of the board */
    uint64_t progress_ns;
    uint32_t progress_row;
    bool stalled;
    bool pin;
    bool edge;
    uint64_t rose_ns;
    uint8_t *script; /* pieces: float64 s, uint32 count, bytes */
    size_t script_bytes;
    size_t script_place;
    size_t piece_end;
    uint64_t piece_ns;
} fake;

static void fail(const char *what)
{
    (void)fprintf(stderr, "faked devices: %s\n", what);
    _Exit(EXIT_FAILURE);
}

static void *load(const char *path, size_t *size)
{
    FILE *file = path == NULL ? NULL : fopen(path, "rb");
    long bytes = -1;
    void *content = NULL;

    if (file != NULL && fseek(file, 0, SEEK_END) == 0) {
        bytes = ftell(file);
        rewind(file);
    }
    if (bytes >= 0) {
        content = malloc((size_t)bytes + 1U);
    }
    if (content == NULL || fread(content, 1U, (size_t)bytes, file) != (size_t)bytes) {
        fail("a file cannot be read");
    }
    (void)fclose(file);
    *size = (size_t)bytes;
    return content;
}

static void next_piece(void)
{
    double time_s;
    uint32_t count;

    while (fake.script_place == fake.piece_end) {
        if (fake.script_bytes - fake.script_place < sizeof time_s + sizeof count) {
            fake.piece_ns = UINT64_MAX;
            return;
        }
        (void)memcpy(&time_s, &fake.script[fake.script_place], sizeof time_s);
        (void)memcpy(&count, &fake.script[fake.script_place + sizeof time_s], sizeof count);
        fake.script_place += sizeof time_s + sizeof count;
        fake.piece_end = fake.script_place + count;
        fake.piece_ns = (uint64_t)(time_s * 1e9);
    }
}

static void plan(const char *text)
{
    unsigned long kind;
    unsigned long row;
    unsigned long amount;

    if (sscanf(text, "%lu:%lu:%lu", &kind, &row, &amount) != 3
        || !hk_virtual_mpu6050_plan(&fake.sensor, (uint32_t)kind, (uint32_t)row,
                                    (uint32_t)amount)) {
        fail("a fault cannot be planned");
    }
}

/* One option with its value; those of other boards are none of ours. */
static void take(const char *option, const char *value)
{
    const uint32_t number = (uint32_t)strtoul(value, NULL, 0);

    if (strcmp(option, "--statistics") == 0) {
        fake.statistics = value;
    } else if (strcmp(option, "--nack") == 0) {
        fake.nack = number;
    } else if (strcmp(option, "--hold-sda") == 0) {
        fake.hold_sda = number;
    } else if (strcmp(option, "--fault-row") == 0) {
        fake.fault_row = number;
    } else if (strcmp(option, "--who-am-i") == 0) {
        hk_virtual_mpu6050_set_identity(&fake.sensor, (uint8_t)number);
    } else if (strcmp(option, "--fault") == 0) {
        plan(value);
    } else if (strcmp(option, "--received") == 0) {
        fake.script = load(value, &fake.script_bytes);
    }
}

/* The options stand one in a line. The first is --settle, for the sensor begins with it. */
void hk_fake_board_begin(void)
{
    const char *given = getenv("HK_FAKE_OPTIONS");
    char *options = given == NULL ? NULL : strdup(given);
    char *word = options == NULL ? NULL : strtok(options, "\n");
    size_t size = 0U;

    if (word == NULL || strcmp(word, "--settle") != 0) {
        fail("HK_FAKE_OPTIONS must begin with --settle");
        return;
    }
    word = strtok(NULL, "\n");
    fake.realtime = strstr(given, "--realtime") != NULL;
    fake.rows = load(getenv("HK_FAKE_TABLE"), &size);
    fake.row_count = (uint32_t)(size / sizeof(double) / HK_ROW_VALUES);
    hk_virtual_mpu6050_init(&fake.sensor, fake.rows, fake.row_count,
                            word == NULL ? 0U : (uint32_t)strtoul(word, NULL, 0), fake.realtime);
    while ((word = strtok(NULL, "\n")) != NULL) {
        if (strcmp(word, "--realtime") != 0) {
            const char *value = strtok(NULL, "\n");

            take(word, value == NULL ? "" : value);
        }
    }
    fake.now_ns = 0U;
    next_piece();
}

bool hk_fake_realtime(void)
{
    return fake.realtime;
}

uint64_t hk_fake_now_ns(void)
{
    return fake.now_ns + (fake.realtime ? fake.wall_start_ns : HK_BOOT_NS);
}

static void arm(void)
{
    if (!fake.armed && hk_virtual_mpu6050_rows_played(&fake.sensor) >= fake.fault_row) {
        fake.armed = true;
        hk_virtual_mpu6050_nack_next(&fake.sensor, fake.nack);
        hk_virtual_mpu6050_hold_sda(&fake.sensor, fake.hold_sda);
    }
}

static void watch_pin(void)
{
    const bool high = hk_virtual_mpu6050_int_pin(&fake.sensor);

    if (high && !fake.pin) {
        fake.edge = true;
        fake.rose_ns = fake.now_ns;
    }
    fake.pin = high;
}

static void pass_to(uint64_t until_ns)
{
    while (fake.now_ns < until_ns) {
        const uint64_t next_ns = hk_virtual_mpu6050_next_event_ns(&fake.sensor);

        fake.now_ns = next_ns > fake.now_ns && next_ns < until_ns ? next_ns : until_ns;
        hk_virtual_mpu6050_advance(&fake.sensor, fake.now_ns);
        watch_pin();
        arm();
    }
}

void hk_fake_pass(uint64_t ns)
{
    if (!fake.realtime) {
        pass_to(fake.now_ns + ns);
    }
}

void hk_fake_catch_up(uint64_t wall_ns)
{
    if (fake.wall_start_ns == 0U) {
        fake.wall_start_ns = wall_ns;
    }
    pass_to(wall_ns - fake.wall_start_ns);
}

uint64_t hk_fake_next_ns(void)
{
    const uint64_t sensor_ns = hk_virtual_mpu6050_next_event_ns(&fake.sensor);
    const uint64_t next_ns = sensor_ns < fake.piece_ns ? sensor_ns : fake.piece_ns;

    return next_ns > UINT64_MAX / 2U ? next_ns : next_ns - fake.now_ns + hk_fake_now_ns();
}

bool hk_fake_ended(void)
{
    const uint32_t row = hk_virtual_mpu6050_rows_played(&fake.sensor);

    if (row != fake.progress_row) {
        fake.progress_row = row;
        fake.progress_ns = fake.now_ns;
    }
    if (fake.realtime) {
        return false;
    }
    fake.stalled = fake.now_ns - fake.progress_ns > HK_STALL_NS;
    return fake.stalled || hk_virtual_mpu6050_exhausted(&fake.sensor);
}

/* Let the time of some bits pass; false if the sensor holds the clock for too long. */
static bool bits(uint64_t count)
{
    const uint64_t held_ns = hk_virtual_mpu6050_stretch_ns(&fake.sensor);

    hk_fake_pass(held_ns > HK_TIMEOUT_NS ? HK_TIMEOUT_NS : held_ns + count * HK_BIT_NS);
    return held_ns <= HK_TIMEOUT_NS;
}

/* What the kernel's adapters do about a bus that is held: up to nine clocks. */
static void recover(void)
{
    int i;

    hk_fake_pass(HK_TIMEOUT_NS);
    for (i = 0; i < HK_RECOVERY_CLOCKS && hk_virtual_mpu6050_sda_low(&fake.sensor); i++) {
        hk_virtual_mpu6050_clock(&fake.sensor);
    }
}

int hk_fake_message(uint8_t address, bool read, uint8_t *bytes, size_t count)
{
    size_t i;

    if (hk_virtual_mpu6050_sda_low(&fake.sensor)) {
        recover();
        return ETIMEDOUT;
    }
    if (!bits(10U)) {
        return ETIMEDOUT;
    }
    if (!hk_virtual_mpu6050_start(&fake.sensor, address, read)) {
        return ENXIO;
    }
    for (i = 0U; i < count; i++) {
        if (!bits(9U)) {
            return ETIMEDOUT;
        }
        if (read) {
            bytes[i] = hk_virtual_mpu6050_read(&fake.sensor);
        } else if (!hk_virtual_mpu6050_write(&fake.sensor, bytes[i])) {
            return EREMOTEIO;
        }
    }
    return 0;
}

void hk_fake_stop(void)
{
    hk_fake_pass(HK_BIT_NS);
    hk_virtual_mpu6050_stop(&fake.sensor);
    watch_pin();
}

bool hk_fake_pin(void)
{
    return fake.pin;
}

bool hk_fake_edge_waits(void)
{
    return fake.edge;
}

bool hk_fake_edge(uint64_t *rose_ns)
{
    const bool edge = fake.edge;

    *rose_ns = fake.rose_ns + (hk_fake_now_ns() - fake.now_ns);
    fake.edge = false;
    return edge;
}

bool hk_fake_receives(void)
{
    return fake.piece_ns <= fake.now_ns;
}

size_t hk_fake_received(uint8_t *bytes, size_t room)
{
    size_t count = 0U;

    while (count < room && hk_fake_receives()) {
        bytes[count++] = fake.script[fake.script_place++];
        next_piece();
    }
    return count;
}

__attribute__((destructor)) static void tell(void)
{
    FILE *file = fake.statistics == NULL ? NULL : fopen(fake.statistics, "w");

    if (file != NULL) {
        (void)fprintf(file, "{\"rows_played\": %lu, \"unread_samples\": %lu, \"stalled\": %d, ",
                      (unsigned long)hk_virtual_mpu6050_rows_played(&fake.sensor),
                      (unsigned long)hk_virtual_mpu6050_unread_samples(&fake.sensor),
                      fake.stalled ? 1 : 0);
        (void)fprintf(file, "\"struck\": %lu, \"time_s\": %.6f}\n",
                      (unsigned long)hk_virtual_mpu6050_struck(&fake.sensor),
                      (double)fake.now_ns / 1e9);
        (void)fclose(file);
    }
}
