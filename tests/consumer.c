/* A program of somebody else's, in C and in C++: it knows the library through pkg-config. */
#include <facet.h>

#include <stdio.h>
#include <string.h>

int main(void)
{
    const float zero = 0.0f, one = 1.0f;
    float radiance[3];
    unsigned char pixel[4];
    facet_target target;
    facet_material material;
    facet_light light;
    facet_batch batch;
    facet_image image;
    facet_plan plan;
    facet_error error;

    memset(&target, 0, sizeof target);
    target.tier = FACET_TIER_STRICT;
    target.arches = facet_arches();
    memset(&material, 0, sizeof material);
    material.diffuse.model = FACET_DIFFUSE_LAMBERT;
    memset(&light, 0, sizeof light);
    light.direction[2] = 1.0f;
    memset(&batch, 0, sizeof batch);
    batch.count = 1;
    batch.lights = &light;
    batch.light_count = 1;
    memset(&image, 0, sizeof image);
    image.width = image.height = 1;
    image.pixels = pixel;
    for (int c = 0; c < 3; c++) {
        material.diffuse.albedo[c] = 1.0f;
        light.irradiance[c] = 3.1415927f;
        batch.normal[c] = c == 2 ? &one : &zero;
        batch.radiance[c] = &radiance[c];
        image.radiance[c] = &radiance[c];
    }
    if (facet_plan_init(&plan, &material, target, &error) || facet_shade(&plan, &batch, &error)
        || facet_encode(&image, &error))
        return 1;
    if (pixel[0] != 255 || pixel[1] != 255 || pixel[2] != 255 || pixel[3] != 255) return 2;
    if (facet_alpha_from_roughness(0.5f) != 0.25f) return 3;
    printf("facet %s\n", facet_version());
    return 0;
}
