"""What the C headers declare. Made by make_declarations.py; not to be changed by hand."""
# mypy: ignore-errors
from ctypes import *  # noqa: F403
from typing import Any, Callable

VERSION = "0.1.0"

LMN_ACTIVITY_SEQUENCE = 0
LMN_ACTIVITY_SIMULTANEITY = 1
LMN_ACTIVITY_TABLE = 2
LMN_ACTIVITY_REVERSE = 3
LMN_ACTIVITY_REPEAT = 4
LMN_ACTIVITY_CREEP = 5
LMN_ACTIVITY_CONSTRAINT = 6
LMN_ACTIVITY_CLIP = 7
LMN_ACTIVITY_EVENT = 8
LMN_FIT_START = 0
LMN_FIT_CENTRE = 1
LMN_FIT_END = 2
LMN_FIT_STRETCH = 3
LMN_FIT_SHRINK = 4
LMN_PROPERTY_TRANSLATION = 0
LMN_PROPERTY_ROTATION = 1
LMN_PROPERTY_SCALE = 2
LMN_PROPERTY_WEIGHTS = 3
LMN_PROPERTY_CAMERA_FOV = 4
LMN_PROPERTY_CAMERA_HALF_HEIGHT = 5
LMN_PROPERTY_LIGHT_COLOUR = 6
LMN_PROPERTY_LIGHT_INTENSITY = 7
LMN_TIME_MAP_CONSTANT = 0
LMN_TIME_MAP_LINEAR = 1
LMN_TIME_MAP_CURVE = 2
LMN_TIME_MAP_TANGENT = 3
LMN_TIME_MAP_FALL = 4
LMN_TIME_MAP_BOUNCE = 5
LMN_TIME_MAP_OSCILLATE = 6
LMN_TIME_MAP_SPIN = 7
LMN_TIME_MAP_FOLLOW = 8
LMN_TIME_MAP_CALLBACK = 9
LMN_CURVE_CATMULL_ROM = 0
LMN_CURVE_BEZIER = 1
LMN_LIGHT_DIRECTIONAL = 0
LMN_LIGHT_POINT = 1
LMN_LIGHT_SPOT = 2
LMN_VIEW_ISO = 0
LMN_VIEW_FRONT = 1
LMN_VIEW_BACK = 2
LMN_VIEW_LEFT = 3
LMN_VIEW_RIGHT = 4
LMN_VIEW_TOP = 5
LMN_VIEW_BOTTOM = 6
LMN_OK = 0
LMN_USAGE = 1
LMN_READ = 2
LMN_FORMAT = 3
LMN_LIMIT = 4
LMN_UNSUPPORTED = 5
LMN_WRITE = 6
LMN_GL = 7
LMN_MEMORY = 8
LMN_CANCELLED = 9
LMN_INTERNAL = 10
LMN_TARGET_DEPTH_IGNORE = 0
LMN_TARGET_DEPTH_TEST_AND_WRITE = 1
LMN_MAP_DEPTH = 0
LMN_MAP_NORMAL = 1
LMN_MAP_ID = 2
LMN_MAP_EDGE = 3
LMN_MAP_SHADE = 4
LMN_MAP_UNCERTAINTY = 5
LMN_MAP_VELOCITY = 6
LMN_MAP_DIRECTION = 7
LMN_PROJECTION_MULTI_PERSPECTIVE = 0
LMN_PROJECTION_PANORAMA = 1
LMN_PARAM_BOOL = 0
LMN_PARAM_INT = 1
LMN_PARAM_FLOAT = 2
LMN_PARAM_ENUM = 3
LMN_PARAM_COLOUR = 4
LMN_PARAM_PALETTE = 5
LMN_PARAM_DIRECTION = 6
LMN_PARAM_TEXT = 7
LMN_UNIT_NONE = 0
LMN_UNIT_POINTS = 1
LMN_UNIT_DEGREES = 2
LMN_UNIT_COUNT = 3
LMN_UNIT_FRACTION = 4
LMN_CHANGE_VALUES = 1
LMN_CHANGE_PLAN = 2
LMN_CHANGE_MESHES = 4
LMN_CHANGE_TEXTURES = 8
LMN_CHANGE_PROGRAMS = 16
LMN_UP_AUTO = 0
LMN_UP_Y = 1
LMN_UP_Z = 2
LMN_THIRD_ANGLE = 0
LMN_FIRST_ANGLE = 1
LMN_SHAPE = 0
LMN_UNION = 1
LMN_INTERSECTION = 2
LMN_DIFFERENCE = 3
LMN_SHAPE_BOX = 1
LMN_SHAPE_SPHERE = 2
LMN_SHAPE_CYLINDER = 3
LMN_SHAPE_POLYHEDRON = 4
LMN_SHAPE_EXTRUSION = 5
LMN_SHAPE_REVOLUTION = 6
LMN_PATTERN_PARALLEL = 0
LMN_PATTERN_CROSS = 1
LMN_PATTERN_CONTOUR = 2
LMN_PATTERN_BRICK = 3
LMN_PATTERN_STIPPLE = 4
LMN_PATTERN_SCRIBBLE = 5
LMN_PATTERN_RANDOM = 6
LMN_ORDER_DRAWN = 0
LMN_ORDER_SHUFFLED = 1
LMN_ORDER_EVEN = 2
LMN_FRACTION_COUNT = 0
LMN_FRACTION_LENGTH = 1
LMN_FRACTION_AREA = 2
LMN_PERSPECTIVE_TIED = 0
LMN_PERSPECTIVE_RANDOM = 1
LMN_PERSPECTIVE_EVEN = 2
LMN_PERSPECTIVE_LAYERS = 3
LMN_FILES_NEAR = 0
LMN_FILES_FOLDER = 1
LMN_FILES_ANY = 2
LMN_LOG_WARNING = 0
LMN_LOG_DRIVER = 1
LMN_PALETTE_MAX = 8
LMN_VALUE_TEXT_MAX = 512
LMN_SOLID_ROOT = 1

lmn_behaviour_fn = CFUNCTYPE(None, c_double, POINTER(c_double), c_void_p)

lmn_behaviour_release_fn = CFUNCTYPE(None, c_void_p)

lmn_progress_fn = CFUNCTYPE(c_bool, c_double, c_char_p, c_void_p)

lmn_alloc_fn = CFUNCTYPE(c_void_p, c_size_t, c_void_p)

lmn_resize_fn = CFUNCTYPE(c_void_p, c_void_p, c_size_t, c_void_p)

lmn_release_fn = CFUNCTYPE(None, c_void_p, c_void_p)

lmn_probe_fn = CFUNCTYPE(c_bool, c_void_p, c_size_t, c_void_p)


class lmn_error(Structure):
    _fields_ = [
        ("status", c_int),
        ("message", c_char * 512),
        ("file", c_char * 512),
        ("line", c_int),
        ("column", c_int),
        ("hint", c_char * 256),
    ]

lmn_import_fn = CFUNCTYPE(c_int, c_void_p, c_char_p, c_void_p, c_size_t, c_void_p, POINTER(lmn_error))

lmn_read_fn = CFUNCTYPE(c_bool, c_char_p, c_char_p, POINTER(c_void_p), POINTER(c_size_t), c_void_p)

lmn_log_fn = CFUNCTYPE(None, c_int, c_char_p, c_char_p, c_void_p)


class lmn_activity_child(Structure):
    _fields_ = [
        ("activity", c_uint32),
        ("start_s", c_double),
        ("duration_s", c_double),
    ]


class lmn_activity_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("kind", c_int),
        ("name", c_char_p),
        ("duration_s", c_double),
        ("children", POINTER(lmn_activity_child)),
        ("child_count", c_size_t),
        ("fit", c_int),
        ("times", c_uint32),
        ("exponent", c_double),
        ("clip", c_char_p),
        ("node", c_uint32),
    ]


class lmn_constraint_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("duration_s", c_double),
        ("node", c_uint32),
        ("property", c_int),
        ("map", c_int),
        ("about_axis", c_bool),
        ("axis", c_double * 3),
        ("values", POINTER(c_double)),
        ("value_count", c_size_t),
        ("times_s", POINTER(c_double)),
        ("curve", c_int),
        ("closed", c_bool),
        ("by_length", c_bool),
        ("forward", c_double * 3),
        ("up", c_double * 3),
        ("start_given", c_bool),
        ("start", c_double * 3),
        ("velocity", c_double * 3),
        ("gravity", c_double * 3),
        ("floor_height", c_double),
        ("restitution", c_double),
        ("amplitude", c_double * 3),
        ("frequency", c_double),
        ("phase", c_double),
        ("rate_deg", c_double),
        ("phase_deg", c_double),
        ("follows", c_uint32),
        ("delay_s", c_double),
        ("offset", c_double * 3),
        ("function", lmn_behaviour_fn),
        ("function_user", c_void_p),
        ("release", lmn_behaviour_release_fn),
    ]


class lmn_lifetime(Structure):
    _fields_ = [
        ("activity", c_uint32),
        ("is_event", c_bool),
        ("node", c_uint32),
        ("property", c_int),
        ("from_s", c_double),
        ("to_s", c_double),
        ("open_from", c_bool),
        ("open_to", c_bool),
    ]


class lmn_point_state(Structure):
    _fields_ = [
        ("time_s", c_double),
        ("position", c_double * 3),
        ("velocity", c_double * 3),
        ("acceleration", c_double * 3),
    ]


class lmn_contact(Structure):
    _fields_ = [
        ("time_s", c_double),
        ("place", c_double * 3),
        ("normal", c_double * 3),
        ("impulse", c_double),
        ("other", c_uint32),
        ("distance", c_double),
    ]


class lmn_mesh_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("positions", POINTER(c_float)),
        ("normals", POINTER(c_float)),
        ("uvs", POINTER(c_float)),
        ("colours", POINTER(c_float)),
        ("joints", POINTER(c_uint16)),
        ("weights", POINTER(c_float)),
        ("vertex_count", c_size_t),
        ("indices", POINTER(c_uint32)),
        ("index_count", c_size_t),
        ("lines", POINTER(c_uint32)),
        ("line_index_count", c_size_t),
        ("material", c_uint32),
    ]


class lmn_material_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("colour", c_float * 4),
        ("texture", c_uint32),
        ("alpha_cutoff", c_float),
        ("unlit", c_bool),
    ]


class lmn_camera_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("orthographic", c_bool),
        ("fov_deg", c_double),
        ("half_height", c_double),
    ]


class lmn_light_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("type", c_int),
        ("colour", c_float * 3),
        ("intensity", c_float),
        ("inner_cone", c_float),
        ("outer_cone", c_float),
    ]


class lmn_node_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("parent", c_uint32),
        ("mesh", c_uint32),
        ("camera", c_uint32),
        ("light", c_uint32),
        ("skin", c_uint32),
        ("matrix", c_double * 16),
    ]


class lmn_depict_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("expressions", c_char_p),
        ("interval_given", c_bool),
        ("from_s", c_double),
        ("to_s", c_double),
    ]


class lmn_depiction_info(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("semantics", c_char_p),
        ("doc", c_char_p),
        ("param_count", c_size_t),
    ]


class lmn_renderer_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("es", c_bool),
        ("debug", c_bool),
        ("adopt", c_bool),
        ("no_restore", c_bool),
    ]


class lmn_draw_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("width", c_int),
        ("height", c_int),
        ("view", c_int),
        ("eye_given", c_bool),
        ("eye", c_double * 3),
        ("target", c_double * 3),
        ("up", c_double * 3),
        ("camera", c_char_p),
        ("orthographic", c_bool),
        ("fov_deg", c_double),
        ("fit", c_double),
        ("time_s", c_double),
        ("seed", c_uint32),
        ("samples", c_int),
        ("background", c_char_p),
        ("select", c_char_p),
        ("maps", c_bool),
        ("profile", c_bool),
        ("progress", lmn_progress_fn),
        ("progress_user", c_void_p),
        ("lenient", c_bool),
        ("time_given", c_bool),
        ("clip", c_char_p),
        ("fit_time", c_bool),
        ("dpi", c_double),
        ("matrices_given", c_bool),
        ("view_matrix", c_double * 16),
        ("projection_matrix", c_double * 16),
        ("textures", c_bool),
        ("draft", c_bool),
        ("fit_direction", c_bool),
        ("window", c_int * 4),
    ]


class lmn_film_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("width", c_int),
        ("height", c_int),
        ("rate", c_double),
        ("frame_count", c_uint32),
        ("format", c_char_p),
        ("progress", lmn_progress_fn),
        ("progress_user", c_void_p),
    ]


class lmn_film_format_info(Structure):
    _fields_ = [
        ("ending", c_char_p),
        ("doc", c_char_p),
        ("program", c_char_p),
        ("package", c_char_p),
        ("usable", c_bool),
    ]


class lmn_target(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("framebuffer", c_uint32),
        ("x", c_int),
        ("y", c_int),
        ("width", c_int),
        ("height", c_int),
        ("depth", c_int),
    ]


class lmn_limits(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("time_s", c_double),
        ("memory", c_uint64),
        ("triangles", c_uint64),
        ("pixels", c_uint64),
        ("textures", c_uint64),
    ]


class lmn_limit_info(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("doc", c_char_p),
        ("standard", c_char * 32),
        ("safe", c_char * 32),
    ]


class lmn_pick(Structure):
    _fields_ = [
        ("part", c_uint32),
        ("position", c_double * 3),
        ("normal", c_double * 3),
        ("depth", c_double),
    ]


class lmn_allocator(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("alloc", lmn_alloc_fn),
        ("resize", lmn_resize_fn),
        ("release", lmn_release_fn),
        ("user", c_void_p),
    ]


class lmn_projection_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("projection", c_int),
        ("angle_deg", c_double),
        ("from", c_double),
        ("to", c_double),
    ]


class lmn_kind_info(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("doc", c_char_p),
        ("technique_count", c_size_t),
        ("standard", c_char_p),
        ("whole_look", c_bool),
        ("several", c_bool),
        ("optional", c_bool),
    ]


class lmn_technique_info(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("doc", c_char_p),
        ("param_count", c_size_t),
        ("common_count", c_size_t),
    ]


class lmn_param_info(Structure):
    _fields_ = [
        ("key", c_char_p),
        ("doc", c_char_p),
        ("type", c_int),
        ("unit", c_int),
        ("min", c_double),
        ("max", c_double),
        ("soft_min", c_double),
        ("soft_max", c_double),
        ("logarithmic", c_bool),
        ("can_auto", c_bool),
        ("default_auto", c_bool),
        ("default_number", c_double),
        ("default_text", c_char * 96),
        ("names", POINTER(c_char_p)),
        ("name_count", c_size_t),
        ("only_if", c_char_p),
        ("auto_from", c_char_p),
        ("common", c_bool),
        ("is_file", c_bool),
        ("is_selector", c_bool),
        ("compiles", c_bool),
    ]


class lmn_motion_way_info(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("doc", c_char_p),
        ("technique", c_char_p),
        ("poses", c_bool),
    ]


class lmn_param_state(Structure):
    _fields_ = [
        ("is_default", c_bool),
        ("is_auto", c_bool),
        ("applies", c_bool),
    ]


class lmn_control_info(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("doc", c_char_p),
    ]


class lmn_control_map(Structure):
    _fields_ = [
        ("param", c_char_p),
        ("times", c_bool),
        ("low", c_double),
        ("high", c_double),
    ]


class lmn_importer(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name", c_char_p),
        ("endings", c_char_p),
        ("probe", lmn_probe_fn),
        ("read", lmn_import_fn),
        ("user", c_void_p),
    ]


class lmn_load_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("up_axis", c_int),
        ("progress", lmn_progress_fn),
        ("progress_user", c_void_p),
        ("defines", POINTER(c_char_p)),
        ("define_count", c_size_t),
        ("strict", c_bool),
        ("importers", POINTER(POINTER(lmn_importer))),
        ("importer_count", c_size_t),
        ("lod", c_char_p),
        ("terrain", c_char_p),
        ("populate", c_double),
        ("deflection", c_double),
    ]


class lmn_scene_info(Structure):
    _fields_ = [
        ("parts", c_size_t),
        ("nodes", c_size_t),
        ("meshes", c_size_t),
        ("materials", c_size_t),
        ("textures", c_size_t),
        ("cameras", c_size_t),
        ("lights", c_size_t),
        ("animations", c_size_t),
        ("skins", c_size_t),
        ("triangles", c_uint64),
        ("lines", c_uint64),
        ("bounds_min", c_double * 3),
        ("bounds_max", c_double * 3),
        ("up", c_char),
    ]


class lmn_part_info(Structure):
    _fields_ = [
        ("id", c_uint32),
        ("name", c_char_p),
        ("path", c_char_p),
        ("triangles", c_uint64),
        ("lines", c_uint64),
        ("instances", c_size_t),
        ("bounds_min", c_double * 3),
        ("bounds_max", c_double * 3),
    ]


class lmn_sheet_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("page", c_char_p),
        ("scale", c_char_p),
        ("unit", c_char_p),
        ("views", c_char_p),
        ("angle", c_int),
        ("title", c_char_p),
        ("frame", c_bool),
        ("plotter", c_bool),
        ("lines_only", c_bool),
        ("fill", c_bool),
        ("verify", c_bool),
        ("smooth", c_double),
        ("line_group", c_double),
        ("centre_lines", c_bool),
        ("sections", c_char_p),
        ("details", c_char_p),
        ("auxiliary", c_char_p),
        ("fields", c_char_p),
        ("loose_hatch", c_bool),
        ("threads", c_char_p),
    ]


class lmn_format_info(Structure):
    _fields_ = [
        ("ending", c_char_p),
        ("doc", c_char_p),
        ("vectors", c_bool),
        ("ground", c_bool),
        ("pictures", c_bool),
        ("areas", c_bool),
        ("title", c_bool),
    ]


class lmn_facets(Structure):
    _fields_ = [
        ("fn", c_double),
        ("fa", c_double),
        ("fs", c_double),
    ]


class lmn_shape(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("kind", c_int),
        ("centred", c_bool),
        ("facets", lmn_facets),
        ("size", c_double * 3),
        ("radius", c_double),
        ("top_radius", c_double),
        ("height", c_double),
        ("twist", c_double),
        ("scale", c_double * 2),
        ("slices", c_uint32),
        ("angle", c_double),
        ("profile", POINTER(c_double * 2)),
        ("profile_count", c_size_t),
        ("contour_sizes", POINTER(c_uint32)),
        ("contour_count", c_size_t),
        ("points", POINTER(c_double * 3)),
        ("point_count", c_size_t),
        ("corners", POINTER(c_uint32)),
        ("face_sizes", POINTER(c_uint32)),
        ("face_count", c_size_t),
    ]


class lmn_solid_info(Structure):
    _fields_ = [
        ("operation", c_int),
        ("parent", c_uint32),
        ("first_child", c_uint32),
        ("next_sibling", c_uint32),
        ("child_count", c_size_t),
        ("name", c_char_p),
        ("matrix", c_double * 16),
        ("has_colour", c_bool),
        ("colour", c_float * 4),
        ("triangles", c_uint64),
        ("is_empty", c_bool),
        ("bounds_min", c_double * 3),
        ("bounds_max", c_double * 3),
        ("part", c_uint32),
    ]


class lmn_stroke(Structure):
    _fields_ = [
        ("u0", c_float),
        ("v0", c_float),
        ("u1", c_float),
        ("v1", c_float),
        ("light", c_float),
        ("perspective", c_float),
        ("layer", c_int32),
    ]


class lmn_pattern_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("pattern", c_int),
        ("count", c_size_t),
        ("length", c_double),
        ("uneven", c_double),
        ("seed", c_uint32),
    ]


class lmn_strokes_view(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("size", c_int),
        ("width", c_double),
        ("light", c_double),
        ("distance", c_double),
    ]


class lmn_task_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("limits", lmn_limits),
        ("progress", lmn_progress_fn),
        ("progress_user", c_void_p),
        ("files", c_int),
        ("allow_paths", POINTER(c_char_p)),
        ("allow_path_count", c_size_t),
        ("read_file", lmn_read_fn),
        ("read_user", c_void_p),
        ("log", lmn_log_fn),
        ("log_user", c_void_p),
        ("in_process", c_bool),
    ]


class lmn_param_desc(Structure):
    _fields_ = [
        ("key", c_char_p),
        ("type", c_int),
        ("standard", c_char_p),
        ("min", c_double),
        ("max", c_double),
        ("soft_min", c_double),
        ("soft_max", c_double),
        ("unit", c_int),
        ("logarithmic", c_bool),
        ("as_light", c_bool),
        ("names", POINTER(c_char_p)),
        ("name_count", c_size_t),
        ("only_if", c_char_p),
        ("doc", c_char_p),
    ]


class lmn_technique_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("param_size", c_size_t),
        ("kind", c_char_p),
        ("name", c_char_p),
        ("doc", c_char_p),
        ("params", POINTER(lmn_param_desc)),
        ("param_count", c_size_t),
        ("glsl", c_char_p),
        ("file", c_char_p),
    ]


class lmn_look_desc(Structure):
    _fields_ = [
        ("struct_size", c_size_t),
        ("name_or_path", c_char_p),
        ("json", c_char_p),
        ("name", c_char_p),
        ("techniques", c_void_p),
    ]


# What the macros LMN_…_INIT make.
STANDARDS: dict[type, Callable[[], Any]] = {
    lmn_activity_desc: lambda: lmn_activity_desc(sizeof(lmn_activity_desc), LMN_ACTIVITY_SEQUENCE, None, 0, None, 0, LMN_FIT_START, 1, 2, None, 0),
    lmn_constraint_desc: lambda: lmn_constraint_desc(sizeof(lmn_constraint_desc), None, 0, 0, LMN_PROPERTY_TRANSLATION, LMN_TIME_MAP_CONSTANT, False, (0, 0, 0,), None, 0, None, LMN_CURVE_CATMULL_ROM, False, False, (0, 0, 0,), (0, 0, 0,), False, (0, 0, 0,), (0, 0, 0,), (0, 0, 0,), 0, 0.7, (0, 0, 0,), 1, 0, 360, 0, 0, 0, (0, 0, 0,), lmn_behaviour_fn(), None, lmn_behaviour_release_fn()),
    lmn_mesh_desc: lambda: lmn_mesh_desc(sizeof(lmn_mesh_desc), None, None, None, None, None, None, None, 0, None, 0, None, 0, 0),
    lmn_material_desc: lambda: lmn_material_desc(sizeof(lmn_material_desc), None, (1, 1, 1, 1,), 0, 0, False),
    lmn_camera_desc: lambda: lmn_camera_desc(sizeof(lmn_camera_desc), None, False, 30, 1),
    lmn_light_desc: lambda: lmn_light_desc(sizeof(lmn_light_desc), None, LMN_LIGHT_DIRECTIONAL, (1, 1, 1,), 1, 0, 45),
    lmn_node_desc: lambda: lmn_node_desc(sizeof(lmn_node_desc), None, 0, 0, 0, 0, 0, ( 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 ,)),
    lmn_depict_desc: lambda: lmn_depict_desc(sizeof(lmn_depict_desc), None, False, 0, 0),
    lmn_renderer_desc: lambda: lmn_renderer_desc(sizeof(lmn_renderer_desc), False, False, False, False),
    lmn_draw_desc: lambda: lmn_draw_desc(sizeof(lmn_draw_desc), 1024, 1024, LMN_VIEW_ISO, False, (0, 0, 0,), (0, 0, 0,), (0, 0, 0,), None, False, 30.0, 0.9, 0.0, 0, 0, None, None, False, False, lmn_progress_fn(), None, False, False, None, False, 0, False, (0,), (0,), False, False, False, ( 0 ,)),
    lmn_film_desc: lambda: lmn_film_desc(sizeof(lmn_film_desc), 1024, 1024, 24.0, 0, None, lmn_progress_fn(), None),
    lmn_target: lambda: lmn_target(sizeof(lmn_target), 0, 0, 0, 0, 0, LMN_TARGET_DEPTH_IGNORE),
    lmn_allocator: lambda: lmn_allocator(sizeof(lmn_allocator), lmn_alloc_fn(), lmn_resize_fn(), lmn_release_fn(), None),
    lmn_projection_desc: lambda: lmn_projection_desc(sizeof(lmn_projection_desc), LMN_PROJECTION_MULTI_PERSPECTIVE, 0, 0.25, 0.75),
    lmn_importer: lambda: lmn_importer(sizeof(lmn_importer), None, None, lmn_probe_fn(), lmn_import_fn(), None),
    lmn_load_desc: lambda: lmn_load_desc(sizeof(lmn_load_desc), LMN_UP_AUTO, lmn_progress_fn(), None, None, 0, False, None, 0, None, None, 0, 0),
    lmn_sheet_desc: lambda: lmn_sheet_desc(sizeof(lmn_sheet_desc), None, None, None, None, LMN_THIRD_ANGLE, None, False, False, False, False, False, 0.02, 0, False, None, None, None, None, False, None),
    lmn_facets: lambda: lmn_facets(0, 12, 2),
    lmn_pattern_desc: lambda: lmn_pattern_desc(sizeof(lmn_pattern_desc), LMN_PATTERN_PARALLEL, 0, 0, 0.5, 0),
    lmn_strokes_view: lambda: lmn_strokes_view(sizeof(lmn_strokes_view), 512, 0, 0, 0),
    lmn_technique_desc: lambda: lmn_technique_desc(sizeof(lmn_technique_desc), sizeof(lmn_param_desc), None, None, None, None, 0, None, None),
    lmn_look_desc: lambda: lmn_look_desc(sizeof(lmn_look_desc), None, None, None, None),
}

FUNCTIONS = {
    "lmn_behaviour_add": (c_int, [c_void_p, POINTER(lmn_activity_desc), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_behaviour_set": (c_int, [c_void_p, c_uint32, POINTER(lmn_activity_desc), POINTER(lmn_error)]),
    "lmn_behaviour_add_constraint": (c_int, [c_void_p, POINTER(lmn_constraint_desc), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_behaviour_set_constraint": (c_int, [c_void_p, c_uint32, POINTER(lmn_constraint_desc), POINTER(lmn_error)]),
    "lmn_behaviour_play": (c_int, [c_void_p, POINTER(c_uint32), c_size_t, POINTER(lmn_error)]),
    "lmn_behaviour_stop": (c_int, [c_void_p, POINTER(lmn_error)]),
    "lmn_behaviour_count": (c_size_t, [c_void_p]),
    "lmn_behaviour_root_at": (c_uint32, [c_void_p, c_size_t]),
    "lmn_dynamics_create": (c_int, [c_void_p, c_char_p, POINTER(c_void_p), POINTER(lmn_error)]),
    "lmn_dynamics_destroy": (None, [POINTER(c_void_p)]),
    "lmn_dynamics_duration": (c_double, [c_void_p]),
    "lmn_dynamics_lifetime_at": (c_bool, [c_void_p, c_size_t, POINTER(lmn_lifetime)]),
    "lmn_dynamics_of_node": (c_int, [c_void_p, c_uint32, c_double, c_double, POINTER(c_uint32), c_size_t, POINTER(c_size_t), POINTER(c_size_t), c_size_t, POINTER(c_size_t), POINTER(lmn_error)]),
    "lmn_dynamics_point": (c_int, [c_void_p, c_uint32, POINTER(c_double), c_double, POINTER(lmn_point_state), POINTER(lmn_error)]),
    "lmn_dynamics_trajectory": (c_int, [c_void_p, c_uint32, POINTER(c_double), c_double, c_double, c_double, POINTER(lmn_point_state), c_size_t, POINTER(c_size_t), POINTER(lmn_error)]),
    "lmn_dynamics_contacts": (c_int, [c_void_p, c_uint32, c_double, c_double, c_double, POINTER(lmn_contact), c_size_t, POINTER(c_size_t), POINTER(lmn_error)]),
    "lmn_scene_add_mesh": (c_int, [c_void_p, POINTER(lmn_mesh_desc), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_scene_set_mesh": (c_int, [c_void_p, c_uint32, POINTER(lmn_mesh_desc), POINTER(lmn_error)]),
    "lmn_scene_set_positions": (c_int, [c_void_p, c_uint32, POINTER(c_float), POINTER(c_float), c_size_t, POINTER(lmn_error)]),
    "lmn_scene_add_texture": (c_int, [c_void_p, c_char_p, c_int, c_int, POINTER(c_uint8), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_scene_add_material": (c_int, [c_void_p, POINTER(lmn_material_desc), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_scene_set_material": (c_int, [c_void_p, c_uint32, POINTER(lmn_material_desc), POINTER(lmn_error)]),
    "lmn_scene_add_camera": (c_int, [c_void_p, POINTER(lmn_camera_desc), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_scene_add_light": (c_int, [c_void_p, POINTER(lmn_light_desc), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_scene_add_skin": (c_int, [c_void_p, POINTER(c_uint32), POINTER(c_double), c_size_t, POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_scene_add_node": (c_int, [c_void_p, POINTER(lmn_node_desc), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_scene_node_of_part": (c_uint32, [c_void_p, c_uint32]),
    "lmn_scene_set_matrix": (c_int, [c_void_p, c_uint32, POINTER(c_double), POINTER(lmn_error)]),
    "lmn_scene_set_instances": (c_int, [c_void_p, c_uint32, POINTER(c_double), c_size_t, POINTER(lmn_error)]),
    "lmn_scene_set_visible": (c_int, [c_void_p, c_uint32, c_bool, POINTER(lmn_error)]),
    "lmn_scene_set_attribute": (c_int, [c_void_p, c_uint32, c_char_p, c_char_p, POINTER(lmn_error)]),
    "lmn_scene_remove_node": (c_int, [c_void_p, c_uint32, POINTER(lmn_error)]),
    "lmn_scene_set_up": (c_int, [c_void_p, c_int, POINTER(lmn_error)]),
    "lmn_scene_begin_changes": (c_int, [c_void_p, POINTER(lmn_error)]),
    "lmn_scene_end_changes": (c_int, [c_void_p, POINTER(lmn_error)]),
    "lmn_depict": (c_int, [c_void_p, POINTER(lmn_draw_desc), POINTER(lmn_depict_desc), POINTER(c_void_p), POINTER(lmn_error)]),
    "lmn_depict_clear": (c_int, [c_void_p, POINTER(lmn_error)]),
    "lmn_look_add_sign_rules": (c_int, [c_void_p, POINTER(lmn_error)]),
    "lmn_depiction_at": (c_bool, [c_size_t, POINTER(lmn_depiction_info)]),
    "lmn_depiction_param_at": (c_bool, [c_size_t, c_size_t, POINTER(lmn_param_info)]),
    "lmn_depiction_reference": (c_void_p, []),
    "lmn_renderer_create": (c_int, [POINTER(c_void_p), POINTER(lmn_renderer_desc), POINTER(lmn_error)]),
    "lmn_renderer_destroy": (None, [POINTER(c_void_p)]),
    "lmn_renderer_json": (c_void_p, [c_void_p]),
    "lmn_scene_best_view": (c_int, [c_void_p, POINTER(lmn_draw_desc), POINTER(lmn_error)]),
    "lmn_draw_check": (c_int, [c_void_p, c_void_p, POINTER(lmn_draw_desc), c_bool, POINTER(lmn_error)]),
    "lmn_draw": (c_int, [POINTER(c_void_p), c_void_p, c_void_p, c_void_p, POINTER(lmn_draw_desc), POINTER(lmn_error)]),
    "lmn_drawing_destroy": (None, [POINTER(c_void_p)]),
    "lmn_drawing_pixels": (POINTER(c_uint8), [c_void_p, POINTER(c_int), POINTER(c_int)]),
    "lmn_drawing_write": (c_int, [c_void_p, c_char_p, c_char_p, POINTER(c_uint64), POINTER(lmn_error)]),
    "lmn_drawing_write_part": (c_int, [c_void_p, POINTER(c_int), c_char_p, c_char_p, POINTER(c_uint64), POINTER(lmn_error)]),
    "lmn_drawing_encode": (c_int, [c_void_p, c_char_p, POINTER(POINTER(c_uint8)), POINTER(c_size_t), POINTER(lmn_error)]),
    "lmn_bytes_free": (None, [POINTER(c_uint8)]),
    "lmn_drawing_write_maps": (c_int, [c_void_p, c_char_p, POINTER(lmn_error)]),
    "lmn_drawing_report_json": (c_void_p, [c_void_p]),
    "lmn_drawing_warning_count": (c_size_t, [c_void_p]),
    "lmn_drawing_warning_at": (c_char_p, [c_void_p, c_size_t, POINTER(c_char_p), POINTER(c_size_t)]),
    "lmn_bench_json": (c_int, [POINTER(c_void_p), c_void_p, c_void_p, POINTER(c_char_p), c_size_t, POINTER(lmn_draw_desc), c_int, POINTER(lmn_error)]),
    "lmn_status_text": (c_char_p, [c_int]),
    "lmn_film_format_at": (c_bool, [c_size_t, POINTER(lmn_film_format_info)]),
    "lmn_film_check": (c_int, [c_char_p, POINTER(lmn_film_desc), POINTER(lmn_error)]),
    "lmn_film_open": (c_int, [POINTER(c_void_p), c_char_p, POINTER(lmn_film_desc), POINTER(lmn_error)]),
    "lmn_film_add": (c_int, [c_void_p, POINTER(c_uint8), POINTER(lmn_error)]),
    "lmn_film_close": (c_int, [POINTER(c_void_p), POINTER(c_uint64), POINTER(lmn_error)]),
    "lmn_film_destroy": (None, [POINTER(c_void_p)]),
    "lmn_film_warning_count": (c_size_t, [c_void_p]),
    "lmn_film_warning_at": (c_char_p, [c_void_p, c_size_t, POINTER(c_char_p), POINTER(c_size_t)]),
    "lmn_picture_is_whole": (c_bool, [c_char_p, c_int, c_int]),
    "lmn_draw_into": (c_int, [c_void_p, c_void_p, c_void_p, POINTER(lmn_draw_desc), POINTER(lmn_target), POINTER(lmn_error)]),
    "lmn_drawing_texture": (c_int, [c_void_p, POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_drawing_map_texture": (c_int, [c_void_p, c_int, POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_drawing_read_back": (c_int, [c_void_p, POINTER(lmn_error)]),
    "lmn_limits_standard": (lmn_limits, []),
    "lmn_limits_safe": (lmn_limits, []),
    "lmn_limits_set": (c_int, [POINTER(lmn_limits), c_char_p, POINTER(lmn_error)]),
    "lmn_limit_at": (c_bool, [c_size_t, POINTER(lmn_limit_info)]),
    "lmn_look_load": (c_int, [POINTER(c_void_p), c_char_p, POINTER(lmn_error)]),
    "lmn_look_parse": (c_int, [POINTER(c_void_p), c_char_p, c_char_p, POINTER(lmn_error)]),
    "lmn_look_destroy": (None, [POINTER(c_void_p)]),
    "lmn_look_set": (c_int, [c_void_p, c_char_p, c_char_p, POINTER(lmn_error)]),
    "lmn_look_json": (c_void_p, [c_void_p]),
    "lmn_look_name": (c_char_p, [c_void_p]),
    "lmn_look_count": (c_size_t, []),
    "lmn_look_name_at": (c_char_p, [c_size_t]),
    "lmn_look_reference_json": (c_int, [POINTER(c_void_p), c_char_p, POINTER(lmn_error)]),
    "lmn_map_components": (c_int, [c_int]),
    "lmn_drawing_copy_map": (c_int, [c_void_p, c_int, c_void_p, c_size_t, POINTER(lmn_error)]),
    "lmn_drawing_pick": (c_int, [c_void_p, c_int, c_int, POINTER(lmn_pick), POINTER(lmn_error)]),
    "lmn_draw_pick": (c_int, [c_void_p, c_void_p, c_void_p, POINTER(lmn_draw_desc), c_int, c_int, POINTER(lmn_pick), POINTER(lmn_error)]),
    "lmn_drawing_pick_parts": (c_int, [c_void_p, c_int, c_int, c_int, c_int, POINTER(c_uint32), c_size_t, POINTER(c_size_t), POINTER(lmn_error)]),
    "lmn_drawing_project": (c_bool, [c_void_p, POINTER(c_double), POINTER(c_double), POINTER(c_double)]),
    "lmn_drawing_unproject": (None, [c_void_p, POINTER(c_double), c_double, POINTER(c_double)]),
    "lmn_drawing_camera": (None, [c_void_p, POINTER(c_double), POINTER(c_double)]),
    "lmn_allocator_set": (c_int, [POINTER(lmn_allocator), POINTER(lmn_error)]),
    "lmn_scene_project": (c_int, [POINTER(c_void_p), c_void_p, POINTER(lmn_draw_desc), POINTER(lmn_projection_desc), POINTER(lmn_error)]),
    "lmn_projection_name": (c_char_p, [c_int]),
    "lmn_kind_count": (c_size_t, []),
    "lmn_kind_at": (c_bool, [c_size_t, POINTER(lmn_kind_info)]),
    "lmn_technique_at": (c_bool, [c_char_p, c_size_t, POINTER(lmn_technique_info)]),
    "lmn_param_at": (c_bool, [c_char_p, c_char_p, c_size_t, POINTER(lmn_param_info)]),
    "lmn_param_find": (c_int, [c_char_p, c_char_p, c_char_p, POINTER(lmn_param_info), POINTER(lmn_error)]),
    "lmn_motion_way_at": (c_bool, [c_size_t, POINTER(lmn_motion_way_info)]),
    "lmn_look_set_motion_way": (c_int, [c_void_p, c_char_p, POINTER(lmn_error)]),
    "lmn_look_motion_way": (c_char_p, [c_void_p]),
    "lmn_look_create": (c_int, [POINTER(c_void_p), POINTER(lmn_error)]),
    "lmn_look_copy": (c_int, [POINTER(c_void_p), c_void_p, POINTER(lmn_error)]),
    "lmn_look_set_name": (c_int, [c_void_p, c_char_p, POINTER(lmn_error)]),
    "lmn_look_doc": (c_char_p, [c_void_p]),
    "lmn_look_set_doc": (c_int, [c_void_p, c_char_p, POINTER(lmn_error)]),
    "lmn_look_revision": (c_uint64, [c_void_p]),
    "lmn_look_changes": (c_uint, [c_void_p, c_uint64]),
    "lmn_look_rule_count": (c_size_t, [c_void_p]),
    "lmn_look_add_rule": (c_int, [c_void_p, c_char_p, c_size_t, POINTER(c_size_t), POINTER(lmn_error)]),
    "lmn_look_remove_rule": (c_int, [c_void_p, c_size_t, POINTER(lmn_error)]),
    "lmn_look_move_rule": (c_int, [c_void_p, c_size_t, c_size_t, POINTER(lmn_error)]),
    "lmn_look_rule_selector": (c_char_p, [c_void_p, c_size_t]),
    "lmn_look_set_rule_selector": (c_int, [c_void_p, c_size_t, c_char_p, POINTER(lmn_error)]),
    "lmn_look_rule_name": (c_char_p, [c_void_p, c_size_t]),
    "lmn_look_set_rule_name": (c_int, [c_void_p, c_size_t, c_char_p, POINTER(lmn_error)]),
    "lmn_look_technique_count": (c_size_t, [c_void_p, c_size_t, c_char_p]),
    "lmn_look_technique": (c_char_p, [c_void_p, c_size_t, c_char_p, c_size_t]),
    "lmn_look_set_technique": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, POINTER(lmn_error)]),
    "lmn_look_add_technique": (c_int, [c_void_p, c_size_t, c_char_p, c_char_p, c_size_t, POINTER(lmn_error)]),
    "lmn_look_remove_technique": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, POINTER(lmn_error)]),
    "lmn_look_move_technique": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_size_t, POINTER(lmn_error)]),
    "lmn_look_param_state": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, POINTER(lmn_param_state), POINTER(lmn_error)]),
    "lmn_look_get_text": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, c_void_p, c_size_t, POINTER(lmn_error)]),
    "lmn_look_set_text": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, c_char_p, POINTER(lmn_error)]),
    "lmn_look_get_number": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, POINTER(c_double), POINTER(lmn_error)]),
    "lmn_look_set_number": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, c_double, POINTER(lmn_error)]),
    "lmn_look_get_colours": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, POINTER(c_float), POINTER(c_size_t), POINTER(lmn_error)]),
    "lmn_look_set_colours": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, POINTER(c_float), c_size_t, POINTER(lmn_error)]),
    "lmn_look_get_direction": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, POINTER(c_double), POINTER(lmn_error)]),
    "lmn_look_set_direction": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, POINTER(c_double), POINTER(lmn_error)]),
    "lmn_look_set_auto": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, POINTER(lmn_error)]),
    "lmn_look_reset": (c_int, [c_void_p, c_size_t, c_char_p, c_size_t, c_char_p, POINTER(lmn_error)]),
    "lmn_control_count": (c_size_t, []),
    "lmn_control_at": (c_bool, [c_size_t, POINTER(lmn_control_info)]),
    "lmn_look_has_control": (c_bool, [c_void_p, c_char_p]),
    "lmn_look_get_control": (c_int, [c_void_p, c_char_p, POINTER(c_double), POINTER(lmn_error)]),
    "lmn_look_set_control": (c_int, [c_void_p, c_char_p, c_double, POINTER(lmn_error)]),
    "lmn_look_control_map": (c_bool, [c_void_p, c_char_p, c_size_t, POINTER(lmn_control_map)]),
    "lmn_look_set_control_maps": (c_int, [c_void_p, c_char_p, POINTER(lmn_control_map), c_size_t, POINTER(lmn_error)]),
    "lmn_scene_create": (c_int, [POINTER(c_void_p), POINTER(lmn_error)]),
    "lmn_scene_destroy": (None, [POINTER(c_void_p)]),
    "lmn_scene_add_file": (c_int, [c_void_p, c_char_p, POINTER(lmn_load_desc), POINTER(lmn_error)]),
    "lmn_scene_info_of": (lmn_scene_info, [c_void_p]),
    "lmn_scene_part_at": (c_bool, [c_void_p, c_size_t, POINTER(lmn_part_info)]),
    "lmn_scene_info_json": (c_void_p, [c_void_p]),
    "lmn_scene_dynamics_json": (c_void_p, [c_void_p]),
    "lmn_step_version": (c_void_p, []),
    "lmn_text_free": (None, [c_void_p]),
    "lmn_text_write": (c_int, [c_char_p, c_char_p, POINTER(lmn_error)]),
    "lmn_look_needs_pixels": (c_bool, [c_void_p]),
    "lmn_page_size": (c_int, [c_char_p, POINTER(c_double), POINTER(c_double), POINTER(lmn_error)]),
    "lmn_draw_sheet": (c_int, [POINTER(c_void_p), c_void_p, c_void_p, c_void_p, POINTER(lmn_draw_desc), POINTER(lmn_sheet_desc), POINTER(lmn_error)]),
    "lmn_sheet_write": (c_int, [c_void_p, c_char_p, c_char_p, POINTER(c_uint64), POINTER(lmn_error)]),
    "lmn_sheet_encode": (c_int, [c_void_p, c_char_p, POINTER(POINTER(c_uint8)), POINTER(c_size_t), POINTER(lmn_error)]),
    "lmn_format_at": (c_bool, [c_size_t, POINTER(lmn_format_info)]),
    "lmn_sheet_report_json": (c_void_p, [c_void_p]),
    "lmn_sheet_warning_count": (c_size_t, [c_void_p]),
    "lmn_sheet_warning_at": (c_char_p, [c_void_p, c_size_t, POINTER(c_char_p), POINTER(c_size_t)]),
    "lmn_sheet_destroy": (None, [POINTER(c_void_p)]),
    "lmn_scene_add_solid": (c_int, [c_void_p, c_char_p, c_int, POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_solid_add_operation": (c_int, [c_void_p, c_uint32, c_uint32, c_int, POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_solid_add_shape": (c_int, [c_void_p, c_uint32, c_uint32, POINTER(lmn_shape), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_solid_add_file": (c_int, [c_void_p, c_uint32, c_uint32, c_char_p, POINTER(lmn_load_desc), POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_solid_add_copy": (c_int, [c_void_p, c_uint32, c_uint32, c_uint32, POINTER(c_uint32), POINTER(lmn_error)]),
    "lmn_solid_set_matrix": (c_int, [c_void_p, c_uint32, c_uint32, POINTER(c_double), POINTER(lmn_error)]),
    "lmn_solid_set_colour": (c_int, [c_void_p, c_uint32, c_uint32, POINTER(c_float), POINTER(lmn_error)]),
    "lmn_solid_set_shown": (c_int, [c_void_p, c_uint32, c_uint32, c_bool, POINTER(lmn_error)]),
    "lmn_solid_set_operation": (c_int, [c_void_p, c_uint32, c_uint32, c_int, POINTER(lmn_error)]),
    "lmn_solid_set_shape": (c_int, [c_void_p, c_uint32, c_uint32, POINTER(lmn_shape), POINTER(lmn_error)]),
    "lmn_solid_set_name": (c_int, [c_void_p, c_uint32, c_uint32, c_char_p, POINTER(lmn_error)]),
    "lmn_solid_remove": (c_int, [c_void_p, c_uint32, c_uint32, POINTER(lmn_error)]),
    "lmn_solid_move": (c_int, [c_void_p, c_uint32, c_uint32, c_uint32, c_uint32, POINTER(lmn_error)]),
    "lmn_scene_solid_count": (c_size_t, [c_void_p]),
    "lmn_scene_solid_at": (c_uint32, [c_void_p, c_size_t]),
    "lmn_solid_is_shown": (c_bool, [c_void_p, c_uint32, c_uint32]),
    "lmn_solid_info_of": (c_bool, [c_void_p, c_uint32, c_uint32, POINTER(lmn_solid_info)]),
    "lmn_strokes_create": (c_int, [POINTER(c_void_p), POINTER(lmn_pattern_desc), POINTER(lmn_error)]),
    "lmn_strokes_load": (c_int, [POINTER(c_void_p), c_char_p, POINTER(lmn_error)]),
    "lmn_strokes_destroy": (None, [POINTER(c_void_p)]),
    "lmn_stroke_pattern_name": (c_char_p, [c_int]),
    "lmn_strokes_count": (c_size_t, [c_void_p]),
    "lmn_strokes_get": (c_int, [c_void_p, c_size_t, POINTER(lmn_stroke), POINTER(lmn_error)]),
    "lmn_strokes_set": (c_int, [c_void_p, c_size_t, POINTER(lmn_stroke), POINTER(lmn_error)]),
    "lmn_strokes_set_light": (c_int, [c_void_p, c_int, c_int, c_double, c_uint32, POINTER(lmn_error)]),
    "lmn_strokes_set_perspective": (c_int, [c_void_p, c_int, c_uint32, POINTER(lmn_error)]),
    "lmn_strokes_write": (c_int, [c_void_p, c_char_p, c_char_p, POINTER(lmn_strokes_view), POINTER(lmn_error)]),
    "lmn_task_desc_standard": (lmn_task_desc, []),
    "lmn_task_begin": (c_int, [POINTER(c_void_p), POINTER(lmn_task_desc), POINTER(lmn_error)]),
    "lmn_task_end": (None, [POINTER(c_void_p)]),
    "lmn_fence_kind": (c_char_p, []),
    "lmn_file_alloc": (c_void_p, [c_size_t]),
    "lmn_techniques_create": (c_int, [POINTER(c_void_p), POINTER(lmn_error)]),
    "lmn_techniques_destroy": (None, [POINTER(c_void_p)]),
    "lmn_techniques_add": (c_int, [c_void_p, POINTER(lmn_technique_desc), POINTER(lmn_error)]),
    "lmn_techniques_at": (c_bool, [c_void_p, c_size_t, POINTER(lmn_technique_info)]),
    "lmn_techniques_param_at": (c_bool, [c_void_p, c_char_p, c_size_t, POINTER(lmn_param_info)]),
    "lmn_look_open": (c_int, [POINTER(c_void_p), POINTER(lmn_look_desc), POINTER(lmn_error)]),
    "lmn_version": (c_char_p, []),
}
