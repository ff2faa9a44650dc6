/* The product that is too large to be placed wherever it is called. */
#include "hk_fixed.h"

#if defined(__AVR__)
/* By bytes, as a * b / 2^32 of unsigned numbers; what that has too much for a negative factor is the
 * other factor. Three bytes hold the sum of a column of products until it is carried on. */
int32_t hk_product(int32_t a, int32_t b)
{
    int32_t high;
    uint8_t low;
    uint8_t middle;
    uint8_t top;
    uint8_t none;

    __asm__("clr %[none]\n\t"
            "clr %A[high]\n\t"
            "clr %B[high]\n\t"
            "clr %C[high]\n\t"
            "clr %D[high]\n\t"
            "sbrs %D[a], 7\n\t"
            "rjmp 1f\n\t"
            "sub %A[high], %A[b]\n\t"
            "sbc %B[high], %B[b]\n\t"
            "sbc %C[high], %C[b]\n\t"
            "sbc %D[high], %D[b]\n"
            "1:\n\t"
            "sbrs %D[b], 7\n\t"
            "rjmp 2f\n\t"
            "sub %A[high], %A[a]\n\t"
            "sbc %B[high], %B[a]\n\t"
            "sbc %C[high], %C[a]\n\t"
            "sbc %D[high], %D[a]\n"
            "2:\n\t"
            "mul %A[a], %A[b]\n\t" /* bytes 0 and 1 */
            "mov %[low], r1\n\t"
            "clr %[middle]\n\t"
            "clr %[top]\n\t"
            "mul %A[a], %B[b]\n\t" /* 1 and 2 */
            "add %[low], r0\n\t"
            "adc %[middle], r1\n\t"
            "adc %[top], %[none]\n\t"
            "mul %B[a], %A[b]\n\t"
            "add %[low], r0\n\t"
            "adc %[middle], r1\n\t"
            "adc %[top], %[none]\n\t"
            "clr %[low]\n\t"
            "mul %A[a], %C[b]\n\t" /* 2 and 3 */
            "add %[middle], r0\n\t"
            "adc %[top], r1\n\t"
            "adc %[low], %[none]\n\t"
            "mul %B[a], %B[b]\n\t"
            "add %[middle], r0\n\t"
            "adc %[top], r1\n\t"
            "adc %[low], %[none]\n\t"
            "mul %C[a], %A[b]\n\t"
            "add %[middle], r0\n\t"
            "adc %[top], r1\n\t"
            "adc %[low], %[none]\n\t"
            "clr %[middle]\n\t"
            "mul %A[a], %D[b]\n\t" /* 3 and 4 */
            "add %[top], r0\n\t"
            "adc %[low], r1\n\t"
            "adc %[middle], %[none]\n\t"
            "mul %B[a], %C[b]\n\t"
            "add %[top], r0\n\t"
            "adc %[low], r1\n\t"
            "adc %[middle], %[none]\n\t"
            "mul %C[a], %B[b]\n\t"
            "add %[top], r0\n\t"
            "adc %[low], r1\n\t"
            "adc %[middle], %[none]\n\t"
            "mul %D[a], %A[b]\n\t"
            "add %[top], r0\n\t"
            "adc %[low], r1\n\t"
            "adc %[middle], %[none]\n\t"
            "add %A[high], %[low]\n\t"
            "adc %B[high], %[middle]\n\t"
            "adc %C[high], %[none]\n\t"
            "adc %D[high], %[none]\n\t"
            "mul %B[a], %D[b]\n\t" /* 4 and 5 */
            "add %A[high], r0\n\t"
            "adc %B[high], r1\n\t"
            "adc %C[high], %[none]\n\t"
            "adc %D[high], %[none]\n\t"
            "mul %C[a], %C[b]\n\t"
            "add %A[high], r0\n\t"
            "adc %B[high], r1\n\t"
            "adc %C[high], %[none]\n\t"
            "adc %D[high], %[none]\n\t"
            "mul %D[a], %B[b]\n\t"
            "add %A[high], r0\n\t"
            "adc %B[high], r1\n\t"
            "adc %C[high], %[none]\n\t"
            "adc %D[high], %[none]\n\t"
            "mul %C[a], %D[b]\n\t" /* 5 and 6 */
            "add %B[high], r0\n\t"
            "adc %C[high], r1\n\t"
            "adc %D[high], %[none]\n\t"
            "mul %D[a], %C[b]\n\t"
            "add %B[high], r0\n\t"
            "adc %C[high], r1\n\t"
            "adc %D[high], %[none]\n\t"
            "mul %D[a], %D[b]\n\t" /* 6 and 7 */
            "add %C[high], r0\n\t"
            "adc %D[high], r1\n\t"
            "clr r1\n\t"
            : [high] "=&r"(high), [low] "=&r"(low), [middle] "=&r"(middle), [top] "=&r"(top),
              [none] "=&r"(none)
            : [a] "r"(a), [b] "r"(b)
            : "r0");
    return high;
}
#elif !HK_LONG_PRODUCT
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
