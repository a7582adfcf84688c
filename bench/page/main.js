// Reads the report and fills the page.

function read(id) {
  return JSON.parse(byId(id).textContent);
}

function showPage() {
  const report = read('report');
  const album = read('album');
  showHeading(report);
  showSummary(report);
  showPictures(report, album);
  showTables(report); // links to existing pictures
  showPlots(report);
  showFooter(report);
  document.documentElement.dataset.ready = 'yes';
}

showPage();
