"""The report's page in a real browser: page_browser_test.py TABLES PARETO HOSTILE BARE STRESS FIGURES FLIGHT
COMPARE, folders with an index.html. Exits with 77 without a browser."""

import json
import pathlib
import re
import sys
import unittest

from page_browser import ARROW_LEFT, ARROW_RIGHT, ENTER, Browser, missing_programs

NAMES = ('tables', 'pareto', 'hostile', 'bare', 'stress', 'figures', 'flight', 'compare')
WIDE = ('tables', 'pareto', 'hostile', 'bare', 'stress')  # tables wider than a phone
PAGES = {}
SKIPPED = 77


def contrast(first, second):
    """The contrast ratio of two colours "rgb(r, g, b)" (WCAG 2.1, 1.4.3)."""
    def luminance(color):
        channels = [int(text) / 255 for text in re.findall(r'\d+', color)[:3]]
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    low, high = sorted([luminance(first), luminance(second)])
    return (high + 0.05) / (low + 0.05)


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.browser.resize(1280, 900)
        self.browser.prefer('light')
        self.browser.console()
        self.browser.requests()
        self.open('tables')

    def open(self, name):
        self.browser.open(PAGES[name])
        self.report = json.loads(self.browser.script("return document.getElementById('report').textContent"))

    def tearDown(self):
        self.assertEqual(self.browser.console(), [], 'the console is not empty')

    # --- loading --------------------------------------------------------------------------------

    def test_nothing_is_fetched_but_the_page_itself(self):
        asked = [url for url in self.browser.requests() if not url.startswith('data:')]
        self.assertEqual(asked, [PAGES['tables'].resolve().as_uri()])

    def test_pictures_are_there_to_be_seen(self):
        self.browser.script("document.querySelectorAll('img').forEach(image => { image.loading = 'eager'; })")
        self.browser.wait_until("return [...document.images].every(image => image.complete)")
        widths = self.browser.script("return [...document.images].map(image => image.naturalWidth)")
        self.assertEqual(widths, [64] * (3 * 5))

    def test_names_that_look_like_markup_stay_text(self):
        self.open('hostile')
        self.assertIsNone(self.browser.script('return window.broken || null'))
        scene = self.report['rows'][-1]['scene']
        self.assertIn('<script>', scene)
        titles = self.browser.script("return [...document.querySelectorAll('#tables h3')].map(node => node.textContent)")
        self.assertTrue(any(scene in title for title in titles), titles)
        self.assertEqual(self.browser.script("return document.querySelectorAll('img[src=x], h3 *').length"), 0)

    def test_page_of_the_stresses_shows_rows_over_limits_first_and_plots_grazing_views(self):
        self.open('stress')
        titles = self.browser.script("return [...document.querySelectorAll('#tables h2')].map(node => node.textContent)")
        self.assertEqual(titles, ['Over a limit', 'Figures'])
        self.assertEqual(self.browser.script("return document.querySelectorAll('.plot path').length"), 2)
        self.assertIsNone(self.browser.script('return window.broken || null'))
        self.assertEqual(self.browser.script("return document.querySelectorAll('#tables td *:not(.tag)').length"), 0)

    # --- documents with columns -----------------------------------------------------------------

    def titles(self):
        return self.browser.script("return [...document.querySelectorAll('#tables h3, #tables summary')].map(node => node.textContent)")

    def names(self):
        return self.browser.script("return [...document.querySelectorAll('#tables tbody th')].map(node => node.textContent)")

    def test_rows_with_columns_are_a_table_for_each_group_and_names_stay_text(self):
        self.open('figures')
        rows = self.report['rows']
        self.assertEqual(self.titles(), [rows[0]['scene'], 'urban'])
        self.assertIn('<script>', rows[0]['scene'])
        self.assertEqual(self.names(), [row['what'] for row in rows])
        self.assertIsNone(self.browser.script('return window.broken || null'))
        self.assertEqual(self.browser.script("return document.querySelectorAll('img').length"), 0)
        heads = self.browser.script("return [...document.querySelectorAll('#tables table')].map(table => [...table.querySelectorAll('thead th')].map(head => head.textContent.replace('↕', '')))")
        self.assertIn('sent, MB', heads[0])
        self.assertNotIn('sent, MB', heads[1], 'no row of it has a value')
        self.assertIn('A note.', self.browser.script("return document.querySelector('.remark').textContent"))

    def test_bars_are_as_long_as_their_figures(self):
        self.open('figures')
        widths = self.browser.script("return [...document.querySelectorAll('.plot')[0].querySelectorAll('.stick')].map(bar => bar.getBoundingClientRect().width)")
        self.assertEqual(len(widths), 2)  # times of two rows
        self.assertAlmostEqual(widths[1] / widths[0], 2.0, delta=0.05)

    def test_a_click_sorts_rows_with_columns_and_all_columns_can_be_shown(self):
        self.open('figures')
        first = self.names()[:2]
        self.browser.script("[...document.querySelectorAll('#tables thead th')].find(head => head.textContent.startsWith('rate')).querySelector('button').click()")
        self.assertEqual(self.names()[:2], first[::-1])
        shown = "return getComputedStyle([...document.querySelectorAll('#tables thead th')].find(head => head.textContent.startsWith('noise'))).display"
        self.assertEqual(self.browser.script(shown), 'none')
        self.browser.click('#details')
        self.assertEqual(self.browser.script(shown), 'table-cell')

    def test_a_flight_shows_its_percentiles_and_a_line_for_each_figure(self):
        self.open('flight')
        values = self.browser.script("return [...document.querySelectorAll('.bar-value')].map(node => node.textContent)")
        self.assertEqual(len(values), 6)
        self.assertIn('frames', self.names())
        self.assertEqual(self.browser.script("return document.querySelectorAll('#tables thead').length"), 0)

    def test_changes_are_shown_by_verdict_and_the_same_ones_are_folded(self):
        self.open('compare')
        self.assertEqual(self.titles()[0], 'worse')
        self.assertTrue(self.titles()[-1].startswith('same: '))
        self.assertFalse(self.browser.script("return document.querySelector('#tables details').open"))
        tiles = self.browser.script("return [...document.querySelectorAll('.tile')].map(tile => tile.textContent)")
        self.assertIn('Worse1', tiles)

    def notice(self):
        return self.browser.script("return (document.querySelector('.notice[role=note]') || {}).textContent || ''")

    def test_what_a_reader_should_be_told_is_told(self):
        self.assertEqual(self.notice(), self.report['notes'][0])

    def test_run_that_ended_early_and_measured_no_error_is_shown_as_far_as_it_goes(self):
        self.open('bare')
        self.assertIn('ended early: interrupted', self.notice())
        names = self.browser.script("return [...document.querySelectorAll('tbody th')].map(node => node.textContent.trim())")
        self.assertEqual(len(names), len(self.report['rows']))
        self.assertTrue(names[0].startswith('texture'), names)
        self.assertEqual(self.browser.script("return document.querySelectorAll('.plot, .comparison').length"), 0)

    # --- plots ----------------------------------------------------------------------------------

    def points(self):
        return self.browser.script('''
            return [...document.querySelectorAll('.point')].map(point => {
                const box = point.querySelector('.marker').getBoundingClientRect();
                const frame = point.closest('svg').getBoundingClientRect();
                return {row: Number(point.dataset.row), plot: point.closest('.plot').querySelector('h3').textContent,
                        x: box.x + box.width / 2, y: box.y + box.height / 2,
                        inside: box.left >= frame.left && box.right <= frame.right && box.top >= frame.top && box.bottom <= frame.bottom};
            });''')

    def plotted_rows(self):
        return [index for index, row in enumerate(self.report['rows'])
                if row['ms'] and not row['null_row'] and row['error']['reprojection_px']]

    def test_every_measured_row_is_one_point(self):
        for page in ('tables', 'pareto'):
            self.open(page)
            points = self.points()
            self.assertEqual(sorted(point['row'] for point in points), self.plotted_rows())
            self.assertGreater(len(points), 8)
            self.assertTrue(all(point['inside'] for point in points))

    def test_points_lie_in_the_order_of_time_and_error(self):
        rows = self.report['rows']
        error = lambda point: rows[point['row']]['error']['reprojection_px']['rms']
        for plot in {point['plot'] for point in self.points()}:
            points = [point for point in self.points() if point['plot'] == plot]
            by_x = sorted(points, key=lambda point: point['x'])
            self.assertEqual(by_x, sorted(points, key=lambda point: rows[point['row']]['ms']['median']))
            by_y = sorted(points, key=lambda point: -round(point['y'], 2))
            self.assertEqual([error(point) for point in by_y], sorted(map(error, points)))

    def test_zero_error_lies_in_the_lane(self):
        point = next(point for point in self.points()
                     if self.report['rows'][point['row']]['error']['reprojection_px']['rms'] == 0)
        lane = self.browser.script("const box = document.querySelector('.lane rect').getBoundingClientRect(); return [box.top, box.bottom]")
        self.assertTrue(lane[0] < point['y'] < lane[1], (lane, point))

    def test_pointing_at_a_point_tells_its_setting(self):
        self.browser.script("document.querySelector('.plot').scrollIntoView({behavior: 'instant', block: 'center'})")
        point = self.points()[1]
        self.browser.hover((point['x'], point['y']))
        self.browser.wait_until("return !document.querySelector('.tip').hidden")
        tip = self.browser.script("return document.querySelector('.tip').textContent")
        self.assertIn(self.report['rows'][point['row']]['label'], tip)
        self.browser.hover((1, 1))
        self.browser.wait_until("return document.querySelector('.tip').hidden")

    def test_arrow_keys_go_from_point_to_point(self):
        focused = 'return Number(document.activeElement.dataset.row)'
        stops = self.browser.script("return document.querySelector('.plot').querySelectorAll('.point[tabindex=\"0\"]').length")
        self.assertEqual(stops, 1)
        self.browser.script("document.querySelector('.point[tabindex=\"0\"]').focus()")
        first = self.browser.script(focused)
        self.browser.press(ARROW_RIGHT)
        second = self.browser.script(focused)
        rows = self.report['rows']
        self.assertLess(rows[first]['ms']['median'], rows[second]['ms']['median'])
        tip = self.browser.script("return document.querySelector('.tip').textContent")
        self.assertIn(rows[second]['label'], tip)
        self.browser.press(ARROW_LEFT)
        self.assertEqual(self.browser.script(focused), first)

    def test_another_error_moves_the_points(self):
        before = self.points()
        self.browser.script("const choice = document.getElementById('measure'); choice.value = 'Wrong surface'; choice.dispatchEvent(new Event('change'))")
        after = self.points()
        self.assertLess({p['row'] for p in before}, {p['row'] for p in after}) # and what shows nothing
        self.assertNotEqual({p['row']: p['y'] for p in before}, {p['row']: p['y'] for p in after})

    def test_point_is_a_link_where_it_leads_to_pictures(self):
        roles = self.browser.script("return [...document.querySelectorAll('.point')].map(point => [Number(point.dataset.row), point.getAttribute('role')])")
        for row, role in roles:
            self.assertEqual(role, 'link' if row < 3 else 'img', row)

    def test_front_without_an_area_and_rows_with_holes_are_told(self):
        self.open('pareto')
        note = self.browser.script("return document.querySelector('.front-note').textContent")
        self.assertIn('No area', note)
        self.assertIn('holes over 0.1 % of the picture: relief:steps=8', note)

    def test_front_is_drawn_where_the_report_has_one(self):
        self.assertEqual(self.browser.script("return document.querySelectorAll('.front').length"), 0)
        self.open('pareto')
        labels = self.browser.script("return [...document.querySelectorAll('.point.on-front')].map(point => point.getAttribute('aria-label').split(',')[0])")
        self.assertEqual(sorted(labels), sorted(self.report['fronts'][0]['front']))
        self.assertEqual(self.browser.script("return document.querySelectorAll('.front').length"), 1)
        self.assertEqual(self.browser.script("return document.querySelectorAll('.point.dominated').length"), 1)

    # --- tables ---------------------------------------------------------------------------------

    def column(self, title):
        return self.browser.script('''
            const table = document.querySelector('table');
            const heads = [...table.querySelectorAll('thead tr:last-child th')];
            const index = heads.findIndex(head => head.textContent.trim() === arguments[0]);
            heads[index].id = 'column';
            return {sort: heads[index].getAttribute('aria-sort'),
                    rows: [...table.tBodies[0].rows].map(row => Number(row.dataset.row))};''', title)

    def sorted_rows(self, value, descending=False):
        rows = self.report['rows']
        group = [index for index, row in enumerate(rows) if row['scene'] == rows[0]['scene']]
        there = [index for index in group if value(rows[index]) is not None]
        there.sort(key=lambda index: value(rows[index]), reverse=descending)
        return there + [index for index in group if index not in there]

    def test_table_sorts_both_ways_and_absent_values_come_last(self):
        median = lambda row: row['ms']['median']
        self.assertIsNone(self.column('median ms')['sort'])
        self.browser.click('#column button')
        self.assertEqual(self.column('median ms'), {'sort': 'ascending', 'rows': self.sorted_rows(median)})
        self.browser.click('#column button')
        self.assertEqual(self.column('median ms'), {'sort': 'descending', 'rows': self.sorted_rows(median, True)})

    def test_table_sorts_by_keyboard_and_one_column_at_a_time(self):
        self.column('median ms')
        self.browser.click('#column button')
        self.browser.script("document.getElementById('column').removeAttribute('id')")
        self.column('technique')
        self.browser.type('#column button', ENTER)
        self.assertEqual(self.column('technique')['sort'], 'ascending')
        self.assertEqual(self.column('technique')['rows'], self.sorted_rows(lambda row: row['label']))
        self.assertEqual(self.browser.script("return document.querySelectorAll('table:first-of-type [aria-sort]').length"), 1)

    def cells(self, title):
        return self.browser.script('''
            return [...document.querySelectorAll('table')].flatMap(table => {
                const heads = [...table.querySelectorAll('thead tr:last-child th')];
                const index = heads.findIndex(head => head.textContent.trim() === arguments[0]);
                return [...table.tBodies[0].rows].map(row => [Number(row.dataset.row), row.cells[index].textContent]);
            });''', title)

    def test_errors_have_their_columns_and_unbounded_pixels_are_told_beside_the_rms(self):
        for row, text in self.cells('RMS'):
            error = (self.report['rows'][row]['error'] or {}).get('reprojection_px')
            self.assertEqual('∞' in text, bool(error and error['unbounded']), text)
            self.assertEqual(text == '–', not error)
        for title in ('p95', 'SSIM'):
            self.assertTrue(any(text != '–' for _, text in self.cells(title)), title)
        self.assertIn('∞', self.browser.script("return document.querySelector('#row-1 .facts').textContent"))

    def test_tiles_leave_out_what_shows_nothing_and_errors_without_a_bound(self):
        tiles = self.browser.script("return [...document.querySelectorAll('.tile')].map(tile => tile.textContent)")
        tile = lambda name: next(text for text in tiles if text.startswith(name))
        self.assertIn('texture', tile('Fastest'))
        self.assertIn('polygons:lods=1', tile('Least RMS'))

    def test_floor_of_the_pictures_errors_is_told_where_there_is_an_exact_row(self):
        floors = self.browser.script("return [...document.querySelectorAll('.floor')].map(node => node.textContent)")
        self.assertEqual(len(floors), 1)
        self.assertIn('SSIM 1.000', floors[0])

    def test_row_of_few_frames_says_why_it_is_noisy(self):
        few = next(index for index, row in enumerate(self.report['rows']) if row['frames'] == 3)
        title = self.browser.script(f"return document.querySelector('tr[data-row=\"{few}\"] .tag.noisy').title")
        self.assertEqual(title, 'Too few frames: 3.')

    def test_noisy_rows_are_marked(self):
        tags = self.browser.script("return [...document.querySelectorAll('tbody tr')].map(row => [Number(row.dataset.row), row.className])")
        for index, names in tags:
            row = self.report['rows'][index]
            self.assertEqual('noisy' in names, row['noisy'])

    # --- slider ---------------------------------------------------------------------------------

    def test_slider_moves_by_keyboard_and_wipes(self):
        slider = '.wipe input[type=range]'
        shape = lambda: self.browser.script("return getComputedStyle(document.querySelector('.over')).clipPath")
        value = lambda: int(self.browser.script(f"return document.querySelector('{slider}').value"))
        begin, begin_shape = value(), shape()
        self.browser.type(slider, ARROW_RIGHT * 5)
        self.assertEqual(value(), begin + 5)
        self.assertNotEqual(shape(), begin_shape)
        self.browser.type(slider, ARROW_LEFT * 5)
        self.assertEqual((value(), shape()), (begin, begin_shape))

    def test_dragging_across_the_picture_moves_the_slider(self):
        self.browser.script("document.querySelector('.stage').scrollIntoView({behavior: 'instant', block: 'center'})")
        box = self.browser.script("const box = document.querySelector('.stage').getBoundingClientRect(); return [box.x, box.y, box.width, box.height]")
        place = lambda share: (box[0] + share * box[2], box[1] + 0.5 * box[3])
        self.browser.drag(place(0.5), place(0.2))
        value = int(self.browser.script("return document.querySelector('.wipe input[type=range]').value"))
        self.assertAlmostEqual(value, 20, delta=1)
        edge = self.browser.script("return document.querySelector('.edge').getBoundingClientRect().x")
        self.assertAlmostEqual(edge, place(0.2)[0], delta=0.012 * box[2] + 2)

    def test_error_can_be_wiped_against_too(self):
        source = "return document.querySelector('.stage > img').src"
        truth = self.browser.script(source)
        self.browser.click('.against label:last-child input')
        heat = self.browser.script(source)
        self.assertTrue(truth.startswith('data:image/jpeg'))
        self.assertTrue(heat.startswith('data:image/png'))

    # --- looks ----------------------------------------------------------------------------------

    def test_phone_page_does_not_scroll_sideways(self):
        for page in NAMES:
            self.browser.resize(390, 844, is_phone=True)
            self.open(page)
            self.assertEqual(self.browser.script('return document.scrollingElement.scrollWidth'), 390, page)
            outside = self.browser.script('''
                return [...document.body.querySelectorAll('*')]
                    .filter(node => !node.closest('.scroll table, .skip, .over, script') && node.getBoundingClientRect().right > 390.5)
                    .map(node => node.outerHTML.slice(0, 120));''')
            self.assertEqual(outside, [], page)
            self.assertTrue(page not in WIDE or self.browser.script('''
                return [...document.querySelectorAll('.scroll')].every(box => box.scrollWidth > box.clientWidth)'''))

    def test_dark_differs_from_light_and_both_can_be_read(self):
        pairs = '''
            const inks = ['h1', '.note', '.environment dt', 'footer', 'td.absent', 'tr.null_row th', '.tag.noisy', '.tip'];
            const ground = node => {
                const color = getComputedStyle(node).backgroundColor;
                return color === 'rgba(0, 0, 0, 0)' ? ground(node.parentElement) : color;
            };
            return inks.map(name => document.querySelector(name)).map(node => [getComputedStyle(node).color, ground(node)]);'''
        light = self.browser.script(pairs)
        self.browser.prefer('dark')
        dark = self.browser.script(pairs)
        for in_light, in_dark in zip(light, dark):
            self.assertNotEqual(in_light, in_dark)
        for ink, ground in light + dark:
            self.assertGreaterEqual(contrast(ink, ground), 4.5, (ink, ground))


if __name__ == '__main__':
    if missing_programs():
        print('not there:', ', '.join(missing_programs()))
        sys.exit(SKIPPED)
    PAGES = {name: pathlib.Path(folder) / 'index.html'
             for name, folder in zip(NAMES, sys.argv[1:])}
    unittest.main(argv=sys.argv[:1], verbosity=2)
