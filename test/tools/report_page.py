"""What an HTML page of the tools holds: its report, packed."""
import base64
import gzip
import json
import re


def page_text(page):
    """The report in a page, as text."""
    return gzip.decompress(base64.b64decode(re.search('id="packed-report">([^<]*)<', page)[1])).decode()


def page_data(page):
    return json.loads(page_text(page))
