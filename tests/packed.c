/* The packed suite. */
#include "packed.h"

void suite_packed(void)
{
    test_packed_mixes();
    test_packed_camera();
    test_packed_bound();
    test_packed_radiance();
    test_past_caches();
}
