// reljef-manual FOLDER: writes the manual pages and completions of reljef, when it is built.
#include "app/cli/manual.h"
#include "app/commands.h"

int main(int argc, char** argv) {
    return argc == 2 ? reljef::cli::write_manual(reljef::app::reljef_program(), argv[1]) : 2;
}
