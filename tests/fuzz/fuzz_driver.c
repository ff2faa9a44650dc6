/* Fuzz the driver: the input is the trouble on the bus, in time and on the INT pin.
 *
 * Whatever happens, nothing hangs or breaks; and once the trouble is over, samples come again. */
#include <stdlib.h>

#include "fuzz_board.h"
#include "hk_app.h"
#include "hk_hal.h"

#define TURNS_AFTER 6000 /* some 15 s of turns of a quarter of a period: refused, retried, settled */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void turn(hk_app_t *app)
{
    if (hk_app_poll(app)) {
        hk_hal_idle();
    } else {
        fuzz_board_pass(10U);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input_t input = {.data = data, .left = size};
    hk_app_t app;
    uint32_t before;
    int i;

    fuzz_board_start(&input);
    hk_app_init(&app);
    while (input.left > 0U) {
        turn(&app);
    }
    before = fuzz_board_samples();
    for (i = 0; i < TURNS_AFTER && fuzz_board_samples() < before + 3U; i++) {
        turn(&app);
    }
    if (fuzz_board_samples() < before + 3U) {
        abort(); /* the driver has not come back */
    }
    return 0;
}
