// What a page has of each motion that it shows, in a scope of its own.

/** The picture of the motion `data` in `figure`; `scale` tells how many pixels a metre has. */
function pictureOf(data, figure, scale) {
/*picture*/
return {
  name: data.name,
  data,
  first,
  last,
  times,
  phases,
  axes,
  quantities,
  energies,
  sensors,
  strongest,
  stage,
  momentAt,
  phaseAt,
  fitting,
  wantedHeight,
  drawStage,
  drawContacts,
  describeStage,
  showKey,
  letTurn,
};
}
