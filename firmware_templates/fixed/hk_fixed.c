/* The product that is too large to be placed wherever it is called. */
#include "hk_fixed.h"

#if !HK_LONG_PRODUCT
int32_t hk_product(int32_t a, int32_t b)
{
    const int16_t a_high = (int16_t)(a >> 16);
    const int16_t b_high = (int16_t)(b >> 16);
    const uint16_t a_low = (uint16_t)a;
    const uint16_t b_low = (uint16_t)b;
    /* Each sum fits: an end of a product of 16 bits leaves room for one more word of 16. */
    const int32_t middle = (int32_t)a_high * b_low + (int32_t)(((uint32_t)a_low * b_low) >> 16);
    const int32_t rest = (int32_t)b_high * a_low + (int32_t)(uint16_t)middle;

    return (int32_t)a_high * b_high + (middle >> 16) + (rest >> 16);
}
#endif
