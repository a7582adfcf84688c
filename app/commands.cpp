#include "app/commands.h"

#include "app/choice/calibrate_command.h"

namespace reljef::app {

cli::Program reljef_program() {
    return {.name = "reljef",
            .description = "reljef draws terrain, fast, and says how wrong each picture is.",
            .verb = "verb",
            .footer = "Examples:\n"
                      "  reljef view natural\n"
                      "  reljef render N45E006.hgt -o alps.png\n"
                      "  reljef render urban --path orbit --frames 100 -o flight.mp4\n"
                      "  reljef info N45E006.hgt --json\n"
                      "  reljef height N45E006.hgt --at 45.8326,6.8652\n"
                      "  reljef profile N45E006.hgt --from 45.83,6.86 --to 45.92,6.87\n"
                      "  reljef viewshed N45E006.hgt --from 45.8326,6.8652,2 -o seen.tif\n"
                      "  reljef index alps.tif\n"
                      "  reljef maps wall_height.png --normals wall_normal.png\n"
                      "'reljef VERB --help' says more.",
            .commands = {add_view_command, add_render_command, add_info_command, add_height_command,
                         add_profile_command, add_viewshed_command, add_index_command,
                         add_maps_command, add_calibrate_command, add_techniques_command}};
}

} // namespace reljef::app
