/* The sensor driver on a bench with the virtual sensor: commands from standard input, one a line,
 * what the driver says on standard output.
 *
 * run MS            poll for so long
 * stall MS          the processor does something else
 * fault KIND AMOUNT plan a fault for the next sample
 * at-once KIND AMOUNT  the same at power-up
 * rate US           rows are motion, one in so many microseconds
 * response AXIS PERCENT, codes X Y Z A, identity N: the sensor's
 * test              ask for the self-test */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hk_hal.h"
#include "hk_mpu6050.h"
#include "hk_virtual_mpu6050.h"

#define BIT_NS     2500U
#define TIMEOUT_NS 1000000U
#define POLL_NS    10000U
#define MS_NS      1000000U

static hk_virtual_mpu6050_t sensor;
static uint64_t now_ns;

static void pass(uint64_t ns)
{
    now_ns += ns;
    hk_virtual_mpu6050_advance(&sensor, now_ns);
}

static bool bits(uint64_t count)
{
    const uint64_t held_ns = hk_virtual_mpu6050_stretch_ns(&sensor);

    pass(held_ns > TIMEOUT_NS ? TIMEOUT_NS : held_ns + count * BIT_NS);
    return held_ns <= TIMEOUT_NS;
}

static bool address_sensor(uint8_t address, bool read)
{
    if (hk_virtual_mpu6050_sda_low(&sensor)) {
        pass(TIMEOUT_NS);
        return false;
    }
    return bits(10U) && hk_virtual_mpu6050_start(&sensor, address, read);
}

static bool write_byte(uint8_t byte)
{
    return bits(9U) && hk_virtual_mpu6050_write(&sensor, byte);
}

static bool release(bool good)
{
    pass(BIT_NS);
    hk_virtual_mpu6050_stop(&sensor);
    return good;
}

bool hk_hal_i2c_write(uint8_t address, const uint8_t *bytes, uint8_t count)
{
    bool good = address_sensor(address, false);
    uint8_t i;

    for (i = 0U; good && i < count; i++) {
        good = write_byte(bytes[i]);
    }
    return release(good);
}

bool hk_hal_i2c_read(uint8_t address, uint8_t reg, uint8_t *bytes, uint8_t count)
{
    bool good = address_sensor(address, false) && write_byte(reg) && address_sensor(address, true);
    uint8_t i;

    for (i = 0U; good && i < count; i++) {
        good = bits(9U);
        bytes[i] = good ? hk_virtual_mpu6050_read(&sensor) : 0U;
    }
    return release(good);
}

void hk_hal_i2c_recover(void)
{
    int i;

    for (i = 0; i < 9 && hk_virtual_mpu6050_sda_low(&sensor); i++) {
        pass(4U * BIT_NS);
        hk_virtual_mpu6050_clock(&sensor);
    }
    (void)release(true);
}

uint32_t hk_hal_time_us(void)
{
    return (uint32_t)(now_ns / 1000U);
}

bool hk_hal_data_ready(uint32_t *time_us)
{
    *time_us = (uint32_t)(hk_virtual_mpu6050_published_ns(&sensor) / 1000U);
    return hk_virtual_mpu6050_int_pin(&sensor);
}

static void idle(void)
{
    uint64_t until = hk_virtual_mpu6050_next_event_ns(&sensor);

    if (until > now_ns + MS_NS) {
        until = now_ns + MS_NS;
    }
    pass(hk_virtual_mpu6050_int_pin(&sensor) ? POLL_NS : until - now_ns);
}

static void say_sample(const hk_mpu6050_sample_t *s)
{
    printf("sample %lu %d %d %d %d %d %d %d %d\n", (unsigned long)s->time_us, s->after_gap ? 1 : 0,
           s->accel[0], s->accel[1], s->accel[2], s->temperature, s->gyro[0], s->gyro[1],
           s->gyro[2]);
}

static void say_test(const hk_mpu6050_t *driver)
{
    unsigned axis;

    printf("tested %d", (int)driver->self_test);
    for (axis = 0U; axis < HK_SELF_TEST_AXES; axis++) {
        printf(" %d %d", driver->tested.response[axis], driver->tested.trim[axis]);
    }
    printf("\n");
}

static void run(hk_mpu6050_t *driver, unsigned long ms)
{
    const uint64_t end_ns = now_ns + (uint64_t)ms * MS_NS;
    hk_mpu6050_sample_t sample;

    while (now_ns < end_ns) {
        switch (hk_mpu6050_poll(driver, hk_hal_time_us(), &sample)) {
        case HK_MPU6050_STARTED:
            printf("started %lu\n", (unsigned long)hk_hal_time_us());
            break;
        case HK_MPU6050_SAMPLE:
            say_sample(&sample);
            break;
        case HK_MPU6050_REFUSAL:
            printf("refused %d\n", driver->who_am_i);
            break;
        case HK_MPU6050_SELF_TESTED:
            say_test(driver);
            break;
        case HK_MPU6050_NOTHING:
            break;
        }
        if (hk_mpu6050_waiting(driver)) {
            idle();
        } else {
            pass(POLL_NS);
        }
    }
}

static void say_counts(const hk_mpu6050_t *driver)
{
    unsigned kind;

    printf("counts");
    for (kind = 0U; kind < HK_MPU6050_KINDS; kind++) {
        printf(" %u", driver->count[kind]);
    }
    printf("\nlost %lu\n", (unsigned long)hk_virtual_mpu6050_unread_samples(&sensor));
}

static void obey(hk_mpu6050_t *driver, const char *line)
{
    unsigned long a = 0U;
    unsigned long b = 0U;
    unsigned long c = 0U;
    unsigned long d = 0U;
    char verb[16] = "";

    (void)sscanf(line, "%15s %lu %lu %lu %lu", verb, &a, &b, &c, &d);
    if (strcmp(verb, "run") == 0) {
        run(driver, a);
    } else if (strcmp(verb, "stall") == 0) {
        pass((uint64_t)a * MS_NS);
    } else if (strcmp(verb, "fault") == 0) {
        (void)hk_virtual_mpu6050_plan(&sensor, (uint32_t)a, 1U, (uint32_t)b);
    } else if (strcmp(verb, "at-once") == 0) {
        (void)hk_virtual_mpu6050_plan(&sensor, (uint32_t)a, 0U, (uint32_t)b);
    } else if (strcmp(verb, "rate") == 0) {
        hk_virtual_mpu6050_feel_motion(&sensor, (uint64_t)a * 1000U);
    } else if (strcmp(verb, "response") == 0) {
        hk_virtual_mpu6050_set_response(&sensor, (uint32_t)a, (double)b / 100.0);
    } else if (strcmp(verb, "codes") == 0) {
        hk_virtual_mpu6050_set_self_test(&sensor, (uint8_t)a, (uint8_t)b, (uint8_t)c, (uint8_t)d);
    } else if (strcmp(verb, "identity") == 0) {
        hk_virtual_mpu6050_set_identity(&sensor, (uint8_t)a);
    } else if (strcmp(verb, "test") == 0) {
        hk_mpu6050_request_self_test(driver);
    } else {
        (void)fprintf(stderr, "not a command: %s", line);
        exit(EXIT_FAILURE);
    }
}

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    static double rows[7U * 100000U];
    static hk_mpu6050_t driver;
    size_t count;
    char line[80];

    if (file == NULL) {
        return EXIT_FAILURE;
    }
    count = fread(rows, 7U * sizeof(double), 100000U, file);
    (void)fclose(file);
    hk_virtual_mpu6050_init(&sensor, rows, (uint32_t)count, HK_SETTLE_SAMPLES, false);
    hk_mpu6050_init(&driver, hk_hal_time_us());
    while (fgets(line, sizeof line, stdin) != NULL) {
        obey(&driver, line);
    }
    say_counts(&driver);
    return EXIT_SUCCESS;
}
