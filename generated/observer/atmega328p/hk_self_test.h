/* The self-test of the MPU-6050 against its factory's figures: register map, section 4.1. */
#ifndef HK_SELF_TEST_H
#define HK_SELF_TEST_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
    HK_SELF_TEST_NONE,    /* none was made */
    HK_SELF_TEST_PASSED,
    HK_SELF_TEST_FAILED,  /* an axis answers otherwise than it did in the factory */
    HK_SELF_TEST_NO_TRIM, /* the factory has left no figure for an axis */
    HK_SELF_TEST_MOVED,   /* the sensor was not at rest */
    HK_SELF_TEST_VARIANT  /* another part, whose self-test is another; none was made */
} hk_self_test_result_t;

#define HK_SELF_TEST_AXES 6U /* accelerometer x, y, z, gyroscope x, y, z */

/* What was found, in counts of +-8 g and +-250 deg/s; valid once the test has ended. */
typedef struct {
    int16_t response[HK_SELF_TEST_AXES]; /* mean with the self-test on less mean with it off */
    int16_t trim[HK_SELF_TEST_AXES];     /* what it was in the factory; 0: not known */
    int32_t sum[HK_SELF_TEST_AXES];      /* while it runs; so are all below */
    uint8_t samples;
    uint8_t writes; /* registers set so far, and those to be set before the next series */
    uint8_t writes_due;
    bool moved;
} hk_self_test_t;

#endif
