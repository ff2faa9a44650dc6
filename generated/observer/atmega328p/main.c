/* The firmware of the ATmega328P. */
#include "hk_app.h"
#include "hk_hal.h"

int main(void)
{
    static hk_app_t app;

    hk_hal_init();
    hk_app_init(&app);
    for (;;) {
        if (hk_app_poll(&app)) {
            hk_hal_idle();
        }
    }
}
