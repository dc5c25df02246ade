// Numbers that C++ (through shared.h) and GLSL must agree on.

// Why a ray stopped.
#define TRACE_NOT_TRACED 0
#define TRACE_HIT 1
#define TRACE_LEFT_SCREEN 2
#define TRACE_PAST_MAX_DISTANCE 3
#define TRACE_OUT_OF_STEPS 4
#define TRACE_FACING_AWAY 5
#define TRACE_STOPPED 6
#define TRACE_IMPOSSIBLE 7

// A pixel and a small number in one uint: x in bits 0..13, y in 14..27, the number in 28..31.
#define PIXEL_BITS 14

// How a ray ended, as that number: its status (0 ... 7); behind the first layer a hit's or stop's tells the layer, too.
SHARED_FUNCTION int number_to_layer(int number) { return number < 8 ? 0 : (number >> 1) - 3; }
SHARED_FUNCTION int number_to_status(int number) { return number < 8 ? number : (number & 1) == 0 ? TRACE_HIT : TRACE_STOPPED; }
SHARED_FUNCTION int status_to_number(int status, int layer) { return layer == 0 ? status : 6 + 2 * layer + (status == TRACE_HIT ? 0 : 1); }

// Rays are traced in groups of this many; a launch is a grid no wider than so many groups.
#define RAYS_PER_GROUP 64
#define LAUNCH_ROW_GROUPS 256

// What becomes of a ray that meets a pixel from behind (core/trace_image.h, Behind).
#define BEHIND_HIT 0
#define BEHIND_PASS 1
#define BEHIND_STOP 2

// Specialization constants; frame_shared.h has more.
#define CONSTANT_SLAB_SLOPE 0
#define CONSTANT_SLAB_SCALE 1
#define CONSTANT_SLAB_SHIFT 2
#define CONSTANT_MAX_DISTANCE_M 3
#define CONSTANT_BEHIND 5
#define CONSTANT_ORTHOGRAPHIC 6

// Background in the depth that tracers read: nearer than nothing, so that no interval touches it.
#define BACKGROUND_DEPTH -1.0
