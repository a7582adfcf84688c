#!/usr/bin/env python3
"""Measures reljef view in a real window: the first picture, panels, and clicks while tiles load.

usage: bench/viewer_times.py RELJEF TILE_1201 TILE_3601 [JSON]

RELJEF is the program, the tiles are elevation files of 1201 and of 3601 samples a side. Prints a table in
Markdown; JSON is a file for all figures. Needs a display and xdotool. Without a screen:
  LIBGL_ALWAYS_SOFTWARE=1 xvfb-run -a -s '-screen 0 1280x1024x24' bench/viewer_times.py ...
"""

import json
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import time

SIZE = (1024, 768)
FIRST_PICTURES = 9  # runs, of which the median counts
FRAMES = 300
CLICKS = 150
PANEL_WIDTH = 280  # at the right of the window, pixels
LIMITS = {'first picture, 1201': 400.0, 'first picture, 3601': 1000.0, 'panels, in flight': 2.0,
          'panels, the pointer moves': 2.0}  # milliseconds, of medians


def command(reljef, tile, *options):
    return [reljef, 'view', tile, '--stats', '--json', '--quiet', '--size', '%dx%d' % SIZE, *options]


def times_in(output):
    """The JSON at the end of what the viewer has printed."""
    return json.loads(output[output.index('{\n'):])


def run(reljef, tile, *options):
    done = subprocess.run(command(reljef, tile, *options), capture_output=True, text=True, check=True)
    return times_in(done.stdout)


def xdotool(*words):
    return subprocess.run(['xdotool', *words], capture_output=True, text=True, check=False).stdout


def window_of(process):
    """Waits for the window with a picture."""
    for _ in range(600):
        found = xdotool('search', '--onlyvisible', '--pid', str(process.pid), '--name', ' - ').split()
        if found and 'opening' not in xdotool('getwindowname', found[0]):
            return found[0]
        time.sleep(0.05)
    raise SystemExit('viewer_times: no window appeared in 30 s, one was expected')


def with_window(reljef, tile, options, act):
    """Runs the viewer, acts on its window, closes it with Esc, and returns its times."""
    with subprocess.Popen(command(reljef, tile, *options), stdout=subprocess.PIPE, text=True) as viewer:
        window = window_of(viewer)
        act(window)
        for _ in range(3):  # a list, the mouse, the window
            xdotool('key', '--window', window, 'Escape')
            time.sleep(0.3)
        output, _ = viewer.communicate(timeout=60)
    return times_in(output)


def first_pictures(reljef, tile):
    seconds = [run(reljef, tile, '--frames', '1')['first_picture_s'] for _ in range(FIRST_PICTURES)]
    return {'median_ms': 1000.0 * statistics.median(seconds), 'max_ms': 1000.0 * max(seconds)}


def over_panels(window):
    """The pointer moves over the panels for some seconds: they are drawn for each frame."""
    end = time.monotonic() + 8.0
    step = 0
    while time.monotonic() < end:
        step += 1
        xdotool('mousemove', '--window', window, str(SIZE[0] - 40 - step % 200), str(200 + step % 300))


def click_controls(window):
    """Clicks anywhere on the panel of the technique, and of the view."""
    places = random.Random(1)
    for _ in range(CLICKS):
        x = SIZE[0] - 12 - places.randrange(PANEL_WIDTH)
        y = 20 + places.randrange(SIZE[1] - 80)
        xdotool('mousemove', '--window', window, str(x), str(y), 'click', '1')


def measure(reljef, tile_1201, tile_3601):
    """All figures: the rows of --stats by the name of the run."""
    flight = ('--path', 'flyover')
    figures = {'first_1201': first_pictures(reljef, tile_1201),
               'first_3601': first_pictures(reljef, tile_3601)}
    figures['shown'] = run(reljef, tile_1201, *flight, '--frames', str(FRAMES))
    figures['hidden'] = run(reljef, tile_1201, *flight, '--no-panels', '--frames', str(FRAMES))
    figures['pointer'] = with_window(reljef, tile_1201, flight, over_panels)
    figures['clicks'] = with_window(reljef, tile_3601, (*flight, '--memory', '16'), click_controls)
    return figures


def table(figures):
    """Lines of Markdown."""
    lines = ['| figure | median | p99 or largest | limit |', '|---|---|---|---|']

    def add(name, row, limit, key='p99_ms'):
        if row.get('count', 1) == 0:
            lines.append(f'| {name} | none | none | {limit} |')
        else:
            lines.append(f'| {name} | {row["median_ms"]:.2f} ms | {row[key]:.2f} ms | {limit} |')

    add('first picture, 1201² samples', figures['first_1201'], '400 ms', 'max_ms')
    add('first picture, 3601² samples', figures['first_3601'], '1000 ms', 'max_ms')
    add('panels of a frame, in flight', figures['shown']['panels'], '2 ms')
    add('panels of a frame that draws them', figures['pointer']['panels_drawn'], '2 ms')
    add('hidden panels of a frame', figures['hidden']['panels_hidden'], '0 ms')
    add('frames with panels', figures['shown']['frames_with_panels'], '')
    add('frames without panels', figures['hidden']['frames_without_panels'], '')
    clicks = figures['clicks']
    for key, name in (('controls', 'answers of controls'),
                      ('controls_while_loading', 'answers of controls while tiles load')):
        add(f'{name}: {clicks[key]["count"]}, within {clicks[key].get("max_frames", 0)} frame(s)',
            clicks[key], '1 frame')
    return lines


def over_limits(figures):
    """Sentences on medians over their limits, and on answers that took more than a frame."""
    found = {'first picture, 1201': figures['first_1201'], 'first picture, 3601': figures['first_3601'],
             'panels, in flight': figures['shown']['panels'],
             'panels, the pointer moves': figures['pointer']['panels']}
    sentences = [f'{name}: {found[name]["median_ms"]:.2f} ms found, at most {limit} ms expected'
                 for name, limit in LIMITS.items() if not found[name]['median_ms'] <= limit]
    frames = figures['clicks']['controls_while_loading'].get('max_frames', 0)
    if frames > 1:
        sentences.append(f'answers of controls while tiles load: {frames} frames found, 1 expected')
    return sentences


def main():
    if len(sys.argv) not in (4, 5):
        raise SystemExit(__doc__)
    reljef, tile_1201, tile_3601 = (str(pathlib.Path(word).resolve()) for word in sys.argv[1:4])
    target = pathlib.Path(sys.argv[4]).resolve() if len(sys.argv) == 5 else None
    with tempfile.TemporaryDirectory() as folder:  # for pictures that clicks save
        os.chdir(folder)
        os.environ['XDG_DATA_HOME'] = folder
        figures = measure(reljef, tile_1201, tile_3601)
        os.chdir('/')
    print('\n'.join(table(figures)))
    if target:
        target.write_text(json.dumps(figures, indent=2) + '\n', encoding='utf-8')
    if sentences := over_limits(figures):
        raise SystemExit('viewer_times: ' + '; '.join(sentences))


if __name__ == '__main__':
    main()
