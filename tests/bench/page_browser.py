"""A headless Chromium, driven through chromedriver's WebDriver protocol (W3C WebDriver)."""

import contextlib
import json
import os
import re
import shutil
import signal
import subprocess
import time
import urllib.error
import urllib.request

ELEMENT = 'element-6066-11e4-a52e-4f735466cecf'  # W3C WebDriver, 12.1
ARROW_RIGHT, ARROW_LEFT, ENTER, TAB = '\ue014', '\ue012', '\ue007', '\ue004'


def missing_programs():
    return [name for name in ('chromium', 'chromedriver') if shutil.which(name) is None]


class Browser:
    def __init__(self):
        self.driver = subprocess.Popen(['chromedriver', '--port=0'], stdout=subprocess.PIPE,
                                       stderr=subprocess.STDOUT, text=True, start_new_session=True)
        self.session = None
        try:
            self.address = f'http://127.0.0.1:{self._port()}/session'
            self.session = self._send('POST', '', {'capabilities': {'alwaysMatch': self._wanted()}})['sessionId']
        except Exception:
            self.close()
            raise

    def close(self):
        # A browser that hangs must not hold up what is finished.
        with contextlib.suppress(OSError):
            if self.session:
                self._send('DELETE', f'/{self.session}', timeout=10)
        os.killpg(self.driver.pid, signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self.driver.wait(timeout=10)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.driver.pid, signal.SIGKILL)
        self.driver.wait()
        self.driver.stdout.close()

    def open(self, page):
        self.call('POST', 'url', {'url': page.resolve().as_uri()})
        self.wait_until("return document.documentElement.dataset.ready === 'yes'")

    def script(self, text, *arguments):
        return self.call('POST', 'execute/sync', {'script': text, 'args': list(arguments)})

    def find(self, selector):
        return self.call('POST', 'element', {'using': 'css selector', 'value': selector})[ELEMENT]

    def click(self, selector):
        self.call('POST', f'element/{self.find(selector)}/click', {})

    def type(self, selector, keys):
        self.call('POST', f'element/{self.find(selector)}/value', {'text': keys})

    def press(self, key):
        self._perform({'type': 'key', 'id': 'keys',
                       'actions': [{'type': 'keyDown', 'value': key}, {'type': 'keyUp', 'value': key}]})

    def drag(self, begin, end):
        """Drags from one point of the window to another."""
        move = [{'type': 'pointerMove', 'duration': 0, 'x': round(x), 'y': round(y)} for x, y in (begin, end)]
        self._perform({'type': 'pointer', 'id': 'mouse', 'parameters': {'pointerType': 'mouse'},
                       'actions': [move[0], {'type': 'pointerDown', 'button': 0}, move[1],
                                   {'type': 'pointerUp', 'button': 0}]})

    def hover(self, place):
        self._perform({'type': 'pointer', 'id': 'mouse', 'parameters': {'pointerType': 'mouse'},
                       'actions': [{'type': 'pointerMove', 'duration': 0, 'x': round(place[0]), 'y': round(place[1])}]})

    def resize(self, width, height, is_phone=False):
        self._devtools('Emulation.setDeviceMetricsOverride',
                       width=width, height=height, deviceScaleFactor=1, mobile=is_phone)

    def prefer(self, scheme):
        """Sets the colour scheme, light or dark, and reduced motion."""
        self._devtools('Emulation.setEmulatedMedia',
                       features=[{'name': 'prefers-color-scheme', 'value': scheme},
                                 {'name': 'prefers-reduced-motion', 'value': 'reduce'}])

    def screenshot(self):
        """The whole page as PNG in base64."""
        return self._devtools('Page.captureScreenshot', captureBeyondViewport=True)['data']

    def console(self):
        """Browser errors since the last call."""
        return [entry['message'] for entry in self.call('POST', 'se/log', {'type': 'browser'})]

    def requests(self):
        """Addresses requested since the last call."""
        entries = self.call('POST', 'se/log', {'type': 'performance'})
        messages = [json.loads(entry['message'])['message'] for entry in entries]
        return [message['params']['request']['url'] for message in messages
                if message['method'] == 'Network.requestWillBeSent']

    def wait_until(self, condition, seconds=20):
        end = time.monotonic() + seconds
        while not self.script(condition):
            if time.monotonic() > end:
                raise TimeoutError(f'not within {seconds} s: {condition}; the console says {self.console()}')
            time.sleep(0.05)

    def call(self, method, path, body=None):
        return self._send(method, f'/{self.session}/{path}', body)

    def _perform(self, source):
        self.call('POST', 'actions', {'actions': [source]})

    def _devtools(self, command, **parameters):
        return self.call('POST', 'goog/cdp/execute', {'cmd': command, 'params': parameters})

    def _port(self):
        for line in self.driver.stdout:
            found = re.search(r'started successfully on port (\d+)', line)
            if found:
                return found.group(1)
        raise RuntimeError('chromedriver ended without a port')

    def _send(self, method, path, body=None, timeout=60):
        request = urllib.request.Request(self.address + path, method=method,
                                         data=None if body is None else json.dumps(body).encode(),
                                         headers={'Content-Type': 'application/json'})
        try:
            with self._opener().open(request, timeout=timeout) as answer:
                return json.load(answer)['value']
        except urllib.error.HTTPError as refused:
            raise RuntimeError(f'{method} {path}: {refused.read().decode()[:400]}') from None

    @staticmethod
    def _opener():
        return urllib.request.build_opener(urllib.request.ProxyHandler({}))  # the driver is here

    @staticmethod
    def _wanted():
        return {'goog:chromeOptions': {'binary': shutil.which('chromium'),
                                       'args': ['--headless=new', '--no-sandbox', '--disable-gpu',
                                                '--disable-dev-shm-usage', '--hide-scrollbars',
                                                '--no-first-run', '--window-size=1280,900']},
                'goog:loggingPrefs': {'browser': 'ALL', 'performance': 'ALL'}}
